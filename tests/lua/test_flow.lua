-- Flow and levels as a script asks for them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- A trunk of 4 along x, and two daughters that end at (10, 3) and (10, -3).
local function fork()
  local net = venule.network {murray = {exponent = 3, tip_radius = 0.1}, unit = "mm"}
  local x = net:add(net:root(0, 0), 4, 0)
  net:add(x, 10, 3)
  net:add(x, 10, -3)
  return net
end

local function resistance(length, radius) return 8 * 3.6e-3 * length / (math.pi * radius ^ 4) end

function testAForkByHand()
  local net = fork()
  local report = net:flow {}
  local r = resistance(4, 0.1 * 2 ^ (1 / 3)) + resistance(math.sqrt(45), 0.1) / 2
  local q = (13332.2 - 7999.32) / r
  lu.assertAlmostEquals(report.inflow, q, 1e-10)
  lu.assertAlmostEquals(report.resistance, r, 1e-9)
  lu.assertAlmostEquals(net.flow[2], q, 1e-10)
  lu.assertAlmostEquals(net.flow[3], q / 2, 1e-10)
  lu.assertEquals(net.flow[1], report.inflow)
  lu.assertEquals({net.pressure[1], net.pressure[3], net.pressure[4]}, {13332.2, 7999.32, 7999.32})
  lu.assertEquals(#net.flow, 4)
  lu.assertEquals(report.terminals.node, {3, 4})
  lu.assertEquals(report.terminals.pressure, {7999.32, 7999.32})
  lu.assertEquals(report.terminals.flow, {net.flow[3], net.flow[4]})
  lu.assertEquals({#report.edge_shear, report.edge_shear[1], #report.join_shear}, {4, 0, 0})
  lu.assertAlmostEquals(report.edge_shear[3], 4 * 3.6e-3 * q / 2 / (math.pi * 0.001), 1e-9)
  lu.assertAlmostEquals(report.wall_shear.min, report.wall_shear.max, 1e-9)
  lu.assertTrue(report.conservation.error < 1e-14 and report.drop.error < 1e-14)
  lu.assertEquals({report.terminal.error, report.terminal.node}, {0, 3})
  lu.assertTrue(report.murray.max < 1e-12)
  lu.assertAlmostEquals(report.fitted.median, 3, 1e-9)
  lu.assertStrContains(tostring(report), "mm³/s; 2 terminals at 7999.32 to 7999.32 Pa")
end

function testFlowsInPlaceOfPressures()
  local net = fork()
  lu.assertAlmostEquals(net:flow {inflow = 6}.inflow, 6, 1e-12)
  lu.assertAlmostEquals(net.flow[3], 3, 1e-12)
  lu.assertEquals(net.pressure[3], 7999.32)
  local report = net:flow {inflow = 6, share = "terminals", pressure_out = 10000}
  lu.assertEquals({net.pressure[1], net.flow[4]}, {13332.2, 3})
  lu.assertTrue(report.terminal.error > 0.01)
  lu.assertEquals(net:flow({terminal_flow = 3}).terminal_pressure, report.terminal_pressure)
end

function testJoinsCarryFlow()
  local net = fork()
  local far = net:add(3, 14, 0)
  lu.assertNil(net:joins()[1])
  net:join(4, far)
  lu.assertNil(net:joins()[1].flow)
  net:add(far, 20, 0)
  local report = net:flow {}
  local join = net:joins()[1]
  lu.assertAlmostEquals(join.flow + net.flow[far], report.inflow, 1e-10)
  lu.assertEquals(#report.join_shear, 1)
  lu.assertTrue(report.join_shear[1] > 0)
  net:scale(2)
  lu.assertNil(net:joins()[1].flow)
end

function testAuditsLeaveThingsAsTheyAre()
  local net = fork()
  net:flow {inflow = 6, share = "terminals"}
  local p = net.pressure[3]
  local report = net:flow {solve = false, pressure_out = p}
  lu.assertEquals({net.pressure[3], report.inflow, report.terminal.error}, {p, 6, 0})
  report = net:flow {solve = false, viscosity = 7.2e-3}
  lu.assertTrue(report.drop.error > 0.1)
  lu.assertEquals(net.pressure[3], p)
  lu.assertEquals(report.drop.node, 3)
end

function testWhatCannotBeSolvedIsSaid()
  local net = fork()
  fails(function() net:flow {solve = false} end, "flow: the network's flows are not known, or have changed since: solve for them (net:flow{…} without solve = false)")
  fails(function() return net.flow[1] end, "network.flow is not known: call net:flow{…} after the last change")
  fails(function() return net.pressure[1] end, "network.pressure is not known: call net:flow{…} after the last change")
  fails(function() net:flow {solve = 1} end, "flow.solve: true or false expected, got number")
  fails(function() net:flow {viscositty = 1} end, "flow: unknown field \"viscositty\", did you mean \"viscosity\"?")
  fails(function() net:flow {inflow = 0} end, "flow.inflow = 0 must be above 0 length³/s: what enters in all, in place of the pressure where `share` says; left out: pressures hold")
  fails(function() net:flow {pressure_in = 1, pressure_out = 2} end, "flow: pressure_in = 1 Pa must be above pressure_out = 2 Pa for anything to flow")
  fails(function() net.x() end, "a column is read by [index], not called")
  local bare = venule.network {}
  bare:add(bare:root(0, 0), 1, 0)
  fails(function() bare:flow {} end, "flow: the network has no radii: give it some by Murray's law (net:murray{…}), or load a file that has them")
  net:close()
  lu.assertFalse(pcall(function() net:flow {} end))
end

function testLevels()
  local net = fork()
  local levels = net:levels()
  lu.assertEquals({#levels, levels.segments, levels[1].level, levels[2].count}, {2, 3, 0, 2})
  lu.assertNil(levels[1].flow)
  lu.assertAlmostEquals(levels[1].diameter.mean, 0.2 * 2 ^ (1 / 3), 1e-15)
  lu.assertAlmostEquals(levels[2].length.mean, math.sqrt(45), 1e-12)
  lu.assertEquals({levels[2].length.deviation, levels.symmetry.min}, {0, 1})
  lu.assertAlmostEquals(levels.angle.mean, 2 * math.deg(math.atan(0.5)), 1e-12)
  lu.assertAlmostEquals(levels.slenderness.max, math.sqrt(45) / 0.2, 1e-9)
  net:flow {inflow = 6}
  lu.assertAlmostEquals(net:levels()[2].flow.mean, 3, 1e-12)
end
