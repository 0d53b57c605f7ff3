-- Widths, orders and measures as a script asks for them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- A ladder: two rails, of which the right one begins at the first rung, and a spike into the second cell.
local function ladder(rungs)
  local net = venule.network {murray = {exponent = 2, tip_radius = 1}, unit = "mm"}
  local left = {net:root(0, 0)}
  local right = {net:add(left[1], 1, 0)}
  for i = 1, rungs do
    left[i + 1] = net:add(left[i], 0, i)
    right[i + 1] = net:add(right[i], 1, i)
    net:join(left[i + 1], right[i + 1])
  end
  net:add(left[2], 0.5, 1.5)
  return net, left, right
end

function testWidthsWhereVeinsMeet()
  local net, left, right = ladder(3)
  local joins = net:joins()
  for i, join in ipairs(joins) do
    lu.assertEquals(join.a, left[i + 1])
    lu.assertEquals(join.radius, net.radius[right[i + 1]])
  end
  lu.assertAlmostEquals(net.radius[left[2]] ^ 2 + net.radius[right[1]] ^ 2, 2, 1e-12)
end

function testJoinsThatWouldMakeACircleAreTurned()
  local net = venule.network {}
  local root = net:root(0, 0)
  local first = net:add(root, 0, 1)
  local last = net:add(net:add(first, 1, 2), 0, 3)
  net:join(last, first, 0.25)
  lu.assertEquals(net:joins(), {{a = last, b = first, radius = 0.25}})
  net:murray {exponent = 2, tip_radius = 1}
  lu.assertEquals(net:joins()[1].a, first)
  lu.assertAlmostEquals(net:joins()[1].radius, math.sqrt(0.5), 1e-12)
end

function testVeinletsWidenTheMainVeins()
  local net = venule.network {murray = {exponent = 2, tip_radius = 1, veinlets = 3}}
  local node = net:root(0, 0)
  for i = 1, 4 do node = net:add(node, 0, i) end
  lu.assertAlmostEquals(net.radius[2], math.sqrt(1 + 3 * 3), 1e-12) -- three nodes from the second to the one before the tip
  lu.assertEquals(net.radius[5], 1)
end

function testOrdersWithARatio()
  local net = venule.network {murray = {}}
  local first = net:add(net:root(0, 0), 0, 1)
  local a, b = net:add(first, -1, 2), net:add(first, 1, 2)
  net:orders "hickey"
  lu.assertEquals({net.order[a], net.order[b]}, {1, 2})
  net:orders("hickey", {ratio = 0.9})
  lu.assertEquals({net.order[a], net.order[b]}, {1, 1})
  fails(function() net:orders("hickey", {ratio = 2}) end, "orders.ratio = 2 must be at most 1: hickey: a lateral this many times as thick as the thickest child has its order too; left out: none has")
end

function testALeafIsMeasuredWhenAsked()
  local net = ladder(4)
  lu.assertNil(net:measure().leaf)
  lu.assertNil(net:measure {leaf = false}.leaf)
  local leaf = net:measure {leaf = true}.leaf
  lu.assertEquals({leaf.areoles, leaf.loops, leaf.crossings}, {4, 4, 0})
  lu.assertEquals({leaf.tips, leaf.free_ends, leaf.area_of, leaf.area}, {1, 1, "hull", 4})
  lu.assertEquals(leaf.areole_areas, {1, 1, 1, 1})
  lu.assertAlmostEquals(leaf.areole_quotient.mean, math.pi / 4, 1e-12)
  lu.assertEquals({leaf.degree3, leaf.degree4, leaf.degree_more}, {5, 1, 0})
  lu.assertEquals({leaf.hierarchy.merges, #leaf.angles.bins}, {3, 5})
  lu.assertAlmostEquals(leaf.density, (13 + math.sqrt(0.5)) / 4, 1e-12)
  local sum = 0
  for _, density in ipairs(leaf.order_density) do sum = sum + density end
  lu.assertAlmostEquals(sum, leaf.density, 1e-12)
end

function testTheBladeMayBeGiven()
  local net = ladder(4)
  local blade = venule.domain.box {min = {-1, -1}, max = {2, 5}}
  local leaf = net:measure {leaf = true, domain = blade, resolution = 0.5}.leaf
  lu.assertEquals({leaf.area_of, leaf.area, leaf.distance.points}, {"domain", 18, 72})
  lu.assertTrue(leaf.distance.max > 1 and leaf.distance.mean < leaf.distance.max)
  local growth = venule.growth.none {domain = blade}
  lu.assertEquals(net:measure {leaf = true, domain = growth}.leaf.area, 18)
end

function testWhatCannotBeMeasured()
  local net = venule.network {dim = 3}
  net:root(0, 0, 0)
  lu.assertEquals(net:measure().nodes, 1)
  fails(function() net:measure {leaf = true} end, "measure: a leaf is flat; give a network and a domain in 2D")
  fails(function() net:measure {leaf = 1} end, "measure.leaf: true or false expected, got number")
  fails(function() net:measure {leav = true} end, 'measure: unknown field "leav", did you mean "leaf"?')
end
