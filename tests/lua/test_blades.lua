-- Blades whose tissue moves or whose unit shrinks, as a script sees them: maps, what is carried along, and every error.
local venule = require "venule"
local lu = require "luaunit"

local domain, growth = venule.domain, venule.growth
local NAN, INF = 0 / 0, math.huge
local NAN_TEXT = ("%g"):format(NAN) -- "nan" or "-nan"

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

local function box()
  return domain.box {min = {-2, -1}, max = {2, 3}}
end

local function leaf(length)
  return domain.profile {length = length or 20, half_width = function(t) return 5 * math.sin(math.pi * t) end}
end

local function assert_at(x, y, expected_x, expected_y, tolerance)
  lu.assertAlmostEquals(x, expected_x, tolerance or 1e-11)
  lu.assertAlmostEquals(y, expected_y, tolerance or 1e-11)
end

local function golden(x, y)
  return growth.rerg {domain = box(), origin = {0, 0}, x = x, y = y, steps = 3}
end

local function refused(x, y, message)
  local ok, err = pcall(golden, x, y)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err:gsub("^[^:]*:%d+: ", ""), message)
end

function testGoldenCasesOfTheAppendix()
  local g = golden(function(y0) return 1 + y0 / 10 end, function(y0) return 1 + y0 / 2 end)
  lu.assertEquals(select(2, g:map(0, 2, 0, 0)), 2)
  assert_at(0, select(2, g:map(0, 2, 0, 3)), 0, 7.5)
  assert_at(0, select(2, g:map(0, 7.5, 3, 0)), 0, 2)
  assert_at(0, select(2, g:map(0, 2, 0, 1)), 0, 3)
  assert_at(0, select(2, g:map(0, -1, 0, 2)), 0, -7 / 12)
  local x, y = golden(function(y0) return 1 + y0 / 10 end):map(1, 2, 0, 3)
  assert_at(x, y, 1.728, 2)
end

-- A function, its samples, a spline through points on a line, and numbers say the same where all of them can.
function testFactorsInEveryForm()
  local function f(y0) return 1.25 + y0 / 4 end
  local points, samples = {{-1, 1}, {0, 1.25}, {2, 1.75}, {3, 2}}, {1, 1.25, 1.5, 1.75, 2}
  for _, form in ipairs {f, samples, points} do
    local g = golden(form, form)
    local x, y = g:map(1, 2, 0, 2)
    local expected = (1.75 ^ 3 - 1.25 ^ 3) / 3 * 4
    assert_at(x, y, 1.75 ^ 2, expected, 1e-9)
  end
  local x, y = golden(1.5, 2):map(1, -1, 0, 3)
  assert_at(x, y, 1.5 ^ 3, -8)
  x, y = golden():map(1, -1, 0, 3)
  assert_at(x, y, 1, -1)
end

-- A spline overshoots no point and stays beyond the last ones.
function testASplineIsMonotone()
  local last, heights = 0, 200
  local g = growth.rerg {domain = box(), origin = {0, 0}, x = {{-0.5, 0.01}, {0, 0.02}, {0.1, 3}, {2.5, 3.001}}}
  for i = 0, heights do
    local x, _ = g:map(1, -1 + 4 * i / heights, 0, 1)
    lu.assertTrue(x >= last - 1e-12 and x >= 0.01 - 1e-12 and x <= 3.001 + 1e-12, x)
    last = x
  end
  lu.assertAlmostEquals(last, 3.001, 1e-12)
end

function testMapsCompose()
  local r = venule.rng(2)
  local blades = {
    golden(function(y0) return 1.1 + 0.3 * math.sin(y0) end, function(y0) return y0 < 1 and 0.8 or 1.4 end),
    growth.uniform {domain = box(), x = 1.1, y = 0.9, steps = 3},
    growth.morph {domains = {leaf(), leaf(30)}, steps = 3},
    growth.isogonic {domain = leaf()}, growth.marginal {domain = leaf()}, growth.none {domain = leaf()},
  }
  for _, g in ipairs(blades) do
    for _ = 1, 40 do
      local x, y, t1, t2, t3 = r:uniform(-2, 2), r:uniform(-1, 3), r:uniform(0, 3), r:uniform(0, 3), r:uniform(0, 3)
      local ax, ay = g:map(x, y, t1, t2)
      local bx, by = g:map(ax, ay, t2, t3)
      local cx, cy = g:map(x, y, t1, t3)
      assert_at(bx, by, cx, cy, 1e-9)
    end
  end
end

function testSolidsGrow()
  local ball = venule.domain.sphere {center = {1, 0, 0}}
  local g = growth.uniform {domain = ball, x = 2, z = 3, steps = 2, split = 0}
  lu.assertEquals(g.origin, {1, -1, 0})
  lu.assertTrue(g:advance())
  lu.assertEquals(g:bounds(), {min = {-1, -1, -3}, max = {3, 1, 3}})
  lu.assertAlmostEquals(g:measure(), 8 * math.pi, 1e-9)
  lu.assertEquals({g:map(2, 0.5, 1, 0, 2)}, {5, 0.5, 9})
  local net, drains = venule.network {dim = 3}, venule.attractors {dim = 3}
  net:root(2, 0, 1)
  drains:add(2, 0, -1)
  lu.assertTrue(g:advance(net, drains))
  lu.assertEquals({net.x[1], net.z[1], drains.x[1], drains.z[1]}, {3, 3, 3, -3})
  local sheet = venule.domain.mesh {vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, faces = {{1, 2, 3}}}
  local grown = growth.isogonic {domain = sheet, from = 2, to = 4, step = 1}
  lu.assertAlmostEquals(grown:measure(), 2, 1e-12)
  lu.assertTrue(grown:contains(0.5, 1, 0))
  lu.assertEquals(#grown:sample(20, {rng = venule.rng(1)}), 20)
end

function testWhatABladeSaysOfItself()
  local g = growth.isogonic {domain = leaf(), from = 10, to = 40, step = 10}
  lu.assertEquals({g.kind, g.time, g.steps, g.length, g.final_length, g.unit, g.grown}, {"isogonic", 0, 3, 10, 40, 1, false})
  lu.assertAlmostEquals(g:bounds().max[2], 10, 1e-12)
  lu.assertTrue(g:advance())
  lu.assertEquals({g.length, g.unit, g:bounds().max[2]}, {20, 0.5, 10})
  lu.assertTrue(g:advance() and g:advance())
  lu.assertFalse(g:advance())
  lu.assertEquals({g.length, g.unit, g.time, g.grown}, {40, 0.25, 3, true})
  local u = growth.uniform {domain = leaf(), y = 2, x = 1, steps = 2}
  lu.assertEquals({u.kind, u.steps, u.length, u.final_length}, {"uniform", 2, 20, 80})
  lu.assertEquals({growth.none {domain = leaf()}.steps, growth.none {domain = leaf()}.grown}, {0, true})
  lu.assertTrue(venule.growth.morph {domains = {leaf(), leaf(5)}}.steps == 100)
end

-- Nets and attractors are moved once, by the last step alone, however often they are handed over.
function testAdvanceCarriesWhatItIsHanded()
  local g = growth.uniform {domain = box(), origin = {0, 0}, x = 2, y = 3, steps = 2, split = 0}
  local net, other, auxin = venule.network {}, venule.network {}, venule.attractors {}
  net:add(net:root(1, 1), 1, 2)
  other:root(-1, 0.5)
  auxin:add(0.5, -0.5)
  lu.assertTrue(g:advance(net, auxin, net, other, auxin))
  lu.assertEquals({net.x[1], net.y[1], net.x[2], net.y[2], other.x[1], other.y[1]}, {2, 3, 2, 6, -2, 1.5})
  lu.assertEquals({auxin.x[1], auxin.y[1]}, {1, -1.5})
  lu.assertTrue(g:advance())
  lu.assertFalse(g:advance(net, auxin))
  lu.assertEquals({net.x[1], auxin.x[1]}, {2, 1})
  lu.assertEquals(#net, 2)
end

function testSplitting()
  local net = venule.network {murray = {exponent = 2, tip_radius = 0.5}}
  local tip = net:add(net:root(0, 0), 0, 2)
  lu.assertEquals(net:split(tip, 0, 1), 3)
  lu.assertEquals({net.parent[tip], net.parent[3], net.radius[3]}, {3, 1, 0.5})
  fails(function() net:split(1, 0, 1) end, "a split needs a node with a parent: a root has no edge above it")
  fails(function() net:split(9, 0, 1) end, "network:split: node 9 is not one of the 3 there are")
  fails(function() net:split(2, 0, NAN) end, "a node at (0, " .. NAN_TEXT .. ", 0) is not finite")
  local g = growth.uniform {domain = box(), origin = {0, 0}, y = 3, steps = 1}
  g:advance(net)
  lu.assertEquals(#net, 5) -- two edges of 3, each above the 2 that is the default
end

local function grow(blade, vein_steps)
  local r, auxin, net = venule.rng(4), venule.attractors {}, venule.network {}
  net:root(blade.origin[1], blade.origin[2])
  repeat
    local growing, u = blade:advance(net, auxin), blade.unit
    if growing then
      auxin:throw {domain = blade, density = 0.02 / u ^ 2, spacing = 2 * u, clearance = 2 * u, network = net, rng = r}
    end
    local added = 0
    for _ = 1, vein_steps do
      added = added + net:extend(auxin:influence(net), {length = u, domain = blade})
      auxin:consume(net, {distance = 1.5 * u})
    end
  until not growing and (#auxin == 0 or added == 0)
  return net, auxin
end

-- The loop of the design on every kind: it ends, what it grew is in the blade, and edges are as short as promised.
function testTheLoopOnEveryKind()
  local shape = leaf()
  local function wide(y0) return 1.03 + 0.03 * math.sin(y0 / 5) end
  local blades = {
    growth.isogonic {domain = shape, from = 20, to = 100, step = 2},
    growth.uniform {domain = shape, x = 1.04, y = 1.03, steps = 40},
    growth.rerg {domain = shape, x = wide, y = wide, steps = 40},
    growth.morph {domains = {shape, leaf(60), domain.disk {center = {0, 40}, radius = 40}}, steps = 60},
  }
  for _, blade in ipairs(blades) do
    local net, auxin = grow(blade, 2)
    lu.assertEquals(#auxin, 0)
    lu.assertTrue(#net > 300, blade.kind .. " has few nodes: " .. #net)
    local size = blade:bounds().max[2]
    for i = 1, #net do
      local p = net.parent[i]
      lu.assertTrue(blade:distance(net.x[i], net.y[i]) > -1e-4 * size, blade.kind)
      if p > 0 and blade.kind ~= "isogonic" then
        local edge = math.sqrt((net.x[i] - net.x[p]) ^ 2 + (net.y[i] - net.y[p]) ^ 2)
        lu.assertTrue(edge <= 2 * (1 + 1e-12), blade.kind .. ": an edge of " .. edge)
      end
    end
  end
end

-- READINGS R7: the poplar takes three vein steps a growth step, the reticulate leaf fourteen.
function testVeinStepsKeepPaceWithTheTip()
  local function steps(blade, segment)
    return venule.venation {domain = blade, rng = venule.rng(1), darts = 1, segment_length = segment}.options.vein_steps
  end
  lu.assertEquals(steps(growth.isogonic {domain = leaf(), from = 115, to = 3500, step = 9}), 3)
  lu.assertEquals(steps(growth.isogonic {domain = leaf(), from = 225, to = 4500, step = 40.5}), 14)
  lu.assertEquals(steps(growth.isogonic {domain = leaf(), from = 225, to = 4500, step = 40.5}, 2), 7)
  lu.assertEquals(steps(growth.marginal {domain = leaf(), from = 225, to = 4500, step = 40.5}), 1)
  lu.assertEquals(steps(growth.rerg {domain = leaf(), y = 8 ^ (1 / 60), steps = 60}), 1)
  lu.assertEquals(steps(growth.rerg {domain = leaf(400), y = 8 ^ (1 / 60), steps = 60}), 16) -- 400 ln 8 / (60 · 7/8)
end

function testVenationOnAnIsogonicBlade()
  local blade = growth.isogonic {domain = leaf(), from = 20, to = 120, step = 4}
  local leaf_veins = venule.venation {
    domain = blade, rng = venule.rng(3), darts = 0.01, birth_distance = 3, kill_distance = 2,
  }
  leaf_veins:run()
  local net, highest = leaf_veins.network, 0
  for i = 1, #net do highest = math.max(highest, net.y[i]) end
  lu.assertEquals(#leaf_veins.attractors, 0)
  lu.assertTrue(highest > 15 and highest < 20, highest)
end

function testFactorsThatAreNone()
  local NONE = " above the origin: a growth factor must be above 0 and finite (1: no growth)"
  refused(function(y0) return 1 - y0 end, 1, "rerg.x = -0.000122078 at height 1.00012" .. NONE)
  refused(function() return NAN end, 1, "rerg.x = " .. NAN_TEXT .. " at height -1" .. NONE)
  refused(1, {1, INF}, "rerg.y = inf at height 3" .. NONE)
  refused(0, 1, "rerg.x = 0 at height -1" .. NONE)
  refused(1, {{0, 1}, {1, -1}}, "rerg.y = -0.000183117 at height 0.500092" .. NONE)
  refused(1, -2, "rerg.y = -2 at height -1" .. NONE)
end

function testFactorsOfTheWrongForm()
  refused("fast", 1, "rerg.x: a function of y0, a table or a number expected, got string")
  refused({1}, 1, "rerg.x: a table of 1 entries, from 2 to 10,000,000 expected")
  refused({1, "2"}, 1, "rerg.x: number expected, got string")
  refused({{1, 2}, 3}, 1, "rerg.x: a point {x, y} expected, got number")
  refused({{1, 2}, {3, 4, 5}}, 1, "rerg.x: a point of a spline has two numbers {y0, f}")
  refused(1, {{1, 2}, {1, 3}},
    "rerg.y: point 2 of the spline is at height 1, not above the one before at 1: give them upwards")
  refused(1, {{1, 2}, {NAN, 3}}, "rerg.y: point 2 of the spline is (" .. NAN_TEXT .. ", 3), which is not finite")
  refused(function() end, 1, "rerg.x at height -1: number expected, got nil")
end

function testAFunctionsOwnErrorKeepsItsLine()
  local line = debug.getinfo(1, "l").currentline + 1
  local function broken(y0) return y0.height end
  local ok, err = pcall(golden, broken)
  lu.assertFalse(ok)
  lu.assertStrContains(err, ("test_blades.lua:%d: attempt to index a number value"):format(line))
end

function testAFunctionThatClosesTheDomain()
  local shape = box()
  local ok, err = pcall(growth.rerg, {domain = shape, x = function() shape:close() return 1 end})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "rerg.domain: domain expected, got venule.domain (closed)")
end

function testNumbersThatMakeNoSense()
  fails(function() growth.isogonic {domain = leaf(), from = 3, to = 2} end,
    "isogonic.from = 3 must not be above isogonic.to = 2: a blade cannot shrink")
  fails(function() growth.isogonic {domain = leaf(), step = 1e-12} end,
    "isogonic.step = 1e-12 takes more than 1e8 steps from 1 to 20; give a longer one")
  fails(function() growth.isogonic {domain = leaf(), split = -1} end,
    "isogonic.split = -1 must be at least 0 length: edges longer than this times the unit are split; 0: none, older edges stretch")
  fails(function() growth.uniform {domain = leaf(), x = 0} end, "uniform.x = 0 must be above 0: growth factor a step across; 1: none")
  fails(function() growth.uniform {domain = leaf(), steps = 0} end, "uniform.steps = 0 must be at least 1 steps: how many steps it grows")
  fails(function() growth.rerg {domain = leaf(), steps = 0} end, "rerg.steps = 0 must be at least 1 steps: how many steps it grows")
  fails(function() growth.rerg {domain = leaf(), sampels = 3} end, 'rerg: unknown field "sampels", did you mean "samples"?')
  fails(function() growth.rerg {domain = leaf(), origin = {0, INF}} end, "rerg.origin must be finite")
  fails(function() growth.rerg {domain = domain.sphere {}} end, "rerg.domain has 3 dimensions, and this growth is of the plane: use venule.growth.uniform or isogonic")
  fails(function() growth.uniform {domain = growth.none {domain = growth.isogonic {domain = leaf()}}} end,
    "a growth of a growing domain: give the shape itself")
  fails(function() golden():map(0, NAN, 0, 1) end, "growth:map: the point (0, " .. NAN_TEXT .. ") is not finite")
  fails(function() golden():map(0, 0, -1, 1) end, "growth:map of rerg: the time -1 must be from 0 to 1e9")
  fails(function() growth.morph {domains = {leaf(), leaf()}, steps = 2}:map(0, 0, 0, 3) end,
    "growth:map of morph: the time 3 is after its last step, 2")
end

function testOutlinesThatCannotMorph()
  fails(function() growth.morph {} end, "morph: `domains` is missing: the outlines from first to last, each of one ring")
  fails(function() growth.morph {domains = leaf()} end, "morph.domains: a table of domains {a, b, …} expected, got userdata")
  fails(function() growth.morph {domains = {leaf()}} end, "morph.domains has 1 outlines; a blade grows between 2 or more")
  fails(function() growth.morph {domains = {leaf(), 3}} end, "morph.domains[2]: domain expected, got number")
  fails(function() growth.morph {domains = {leaf(), leaf(), leaf()}, steps = 1} end,
    "morph.steps = 1 must be 2 or more: one from each outline to the next")
  fails(function() growth.morph {domains = {leaf(), leaf() - domain.disk {center = {0, 10}}}} end,
    "morph.domains[2] has 2 outlines; those between which a blade grows have one")
  fails(function() growth.morph {domains = {leaf(), domain.sphere {}}} end, "morph.domains[2] must be flat and must not grow itself")
end

-- A hook whose end goes over to the other side runs into itself.
function testABladeThatCrossesItselfStops()
  local hook = domain.polygon {{0, 0}, {10, 0}, {10, 10}, {2, 10}, {2, 8}, {8, 8}, {8, 2}, {0, 2}}
  local turned = domain.polygon {{0, 0}, {10, 0}, {10, 2}, {2, 2}, {2, 8}, {8, 8}, {8, 10}, {0, 10}}
  local blade, net = growth.morph {domains = {hook, turned}, steps = 30}, venule.network {}
  net:root(0, 0)
  local good, err
  repeat
    local time, area = blade.time, blade:measure()
    good, err = pcall(blade.advance, blade, net)
    if not good then lu.assertEquals({blade.time, blade:measure()}, {time, area}) end
  until not good
  lu.assertStrContains(err, ("morph: at step %d: the outline crosses itself near ("):format(blade.time + 1))
end
