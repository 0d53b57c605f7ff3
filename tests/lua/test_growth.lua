-- Laws of whole scenarios, as a script sees them: the loop of the papers written out by hand, and what it is made of.
local venule = require "venule"
local lu = require "luaunit"

local domain, growth = venule.domain, venule.growth
local FILES = "../files/svg/" -- beside this file

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- A blade with a notch at each side: concave, and star-shaped about its petiole at (0, 0).
local function notched()
  return domain.polygon {{0, 0}, {30, 20}, {22, 45}, {26, 60}, {0, 100}, {-26, 60}, {-22, 45}, {-30, 20}}
end

-- No attractor within `distance` of a node: every pair is looked at. `nodes` keeps the coordinates that were read before.
local function assert_none_within(auxin, net, distance, nodes)
  local x, y, ax, ay = net.x, net.y, auxin.x, auxin.y
  for i = #nodes + 1, #net do nodes[i] = {x[i], y[i]} end
  for k = 1, #auxin do
    local px, py = ax[k], ay[k]
    for i = 1, #nodes do
      local dx, dy = nodes[i][1] - px, nodes[i][2] - py
      if dx * dx + dy * dy < distance * distance then
        lu.fail(("attractor %d is %.17g from node %d after consume(%g)"):format(k, math.sqrt(dx * dx + dy * dy), i, distance))
      end
    end
  end
end

-- The loop of the design, with marginal growth. `o.look(auxin, net)` is called after each consume.
local function grow(o)
  local shape = o.shape or notched()
  local blade = growth.marginal {domain = shape, from = 10, to = o.to or 100, step = o.step or 5}
  local veins = venule.network {murray = {exponent = 2.5, tip_radius = 0.1}}
  local auxin = venule.attractors {}
  local rng = venule.rng(o.seed or 1)
  local steps, growing = 0, true
  veins:root(0, 0)
  repeat
    growing = blade:advance(veins, auxin)
    auxin:throw {
      domain = blade, density = 0.05, spacing = 4, clearance = o.clearance or 4, network = veins, rng = rng,
    }
    for _ = 1, 3 do
      veins:extend(auxin:influence(veins), {length = blade.unit, domain = blade})
      auxin:consume(veins, {distance = o.kill or 2})
      if o.look then o.look(auxin, veins, blade) end
    end
    venule.frame()
    steps = steps + 1
    lu.assertTrue(steps < 2000, "the loop does not end")
  until not growing and #auxin == 0
  return veins, auxin, blade, shape
end

local function text_of(net)
  local lines = {}
  for i = 1, #net do
    lines[i] = ("%a %a %d %a %d"):format(net.x[i], net.y[i], net.parent[i], net.radius[i], net.birth[i])
  end
  return table.concat(lines, "\n")
end

function testTheLoopEndsWithEverySourceReached()
  local veins, auxin, blade = grow {}
  lu.assertEquals(#auxin, 0)
  lu.assertEquals(auxin.dormant, 0)
  lu.assertTrue(#veins > 300, #veins .. " nodes are few")
  lu.assertEquals(blade.length, 100)
  lu.assertFalse(blade:advance(veins, auxin))
end

function testEveryNodeAndEdgeIsInside()
  local veins, _, _, shape = grow {}
  local x, y, parent = veins.x, veins.y, veins.parent
  for i = 1, #veins do
    lu.assertTrue(shape:distance(x[i], y[i]) >= -1e-9 * 100, ("node %d is outside"):format(i))
    for k = 1, 3 do
      local p, t = parent[i], k / 4
      if p > 0 then
        local qx, qy = x[i] + t * (x[p] - x[i]), y[i] + t * (y[p] - y[i])
        lu.assertTrue(shape:distance(qx, qy) >= -1e-9 * 100, ("the edge of node %d is outside"):format(i))
      end
    end
  end
end

-- At each step the veins are inside the blade of that day, not only inside the grown one.
function testVeinsAreInsideTheBladeOfTheDay()
  local seen = 0
  grow {step = 9, look = function(_, net, blade)
    local x, y = net.x, net.y
    for i = seen + 1, #net do
      lu.assertTrue(blade:distance(x[i], y[i]) >= -1e-9 * 100, ("node %d is outside at length %g"):format(i, blade.length))
    end
    seen = #net
  end}
  lu.assertTrue(seen > 100)
end

function testConsumeLeavesNothingWithinTheKillDistance()
  local nodes = {}
  grow {look = function(auxin, net) assert_none_within(auxin, net, 2, nodes) end}
end

-- New sources against old nodes: with less clearance than kill distance some are born too near, and must go at once.
function testConsumeLooksAtOldNodesToo()
  local nodes = {}
  grow {clearance = 0.5, kill = 3.5, look = function(auxin, net) assert_none_within(auxin, net, 3.5, nodes) end}
end

function testMurrayHoldsAtEveryJunction()
  local veins = grow {}
  local radius, parent, junctions = veins.radius, veins.parent, 0
  for i = 1, #veins do
    local children = veins:children(i)
    if #children == 0 then
      lu.assertAlmostEquals(radius[i], 0.1, 1e-12)
    elseif parent[i] > 0 then
      local sum = 0
      for _, c in ipairs(children) do
        lu.assertEquals(parent[c], i)
        sum = sum + radius[c] ^ 2.5
      end
      lu.assertAlmostEquals(radius[i] ^ 2.5 / sum, 1, 1e-9)
      junctions = junctions + (#children > 1 and 1 or 0)
    else
      local thickest = 0
      for _, c in ipairs(children) do thickest = math.max(thickest, radius[c]) end
      lu.assertEquals(radius[i], thickest)
    end
  end
  lu.assertEquals(junctions, veins:measure().bifurcations)
  lu.assertTrue(junctions > 20)
end

function testSegmentsHaveTheirLength()
  local veins = grow {}
  for i = 2, #veins do
    local p = veins.parent[i]
    local dx, dy = veins.x[i] - veins.x[p], veins.y[i] - veins.y[p]
    lu.assertAlmostEquals(math.sqrt(dx * dx + dy * dy), 1, 1e-9)
    lu.assertTrue(veins.birth[i] >= veins.birth[p])
  end
end

function testTheSameSeedGrowsTheSame()
  local one, other = text_of((grow {seed = 7})), text_of((grow {seed = 7}))
  lu.assertTrue(one == other, "two runs of one seed differ")
  lu.assertFalse(one == text_of((grow {seed = 8})), "two seeds grow the same")
end

-- Influence.

local function field_of(seed, count)
  local auxin, net, rng = venule.attractors {}, venule.network {}, venule.rng(seed)
  auxin:throw {domain = domain.disk {}, count = count, rng = rng}
  net:root(0, 0)
  for _ = 1, 40 do
    net:extend(auxin:influence(net), {length = 0.05})
    auxin:consume(net, {distance = 0.03})
  end
  return auxin, net
end

function testPairsAreByAttractorAndNearest()
  local auxin, net = field_of(3, 300)
  local f = auxin:influence(net)
  local last, pairs_seen = 0, 0
  for attractor, node in f:pairs() do
    lu.assertTrue(attractor > last, "attractors must come in order, each once")
    last = attractor
    pairs_seen = pairs_seen + 1
    local px, py, least = auxin.x[attractor], auxin.y[attractor], math.huge
    for i = 1, #net do least = math.min(least, (net.x[i] - px) ^ 2 + (net.y[i] - py) ^ 2) end
    lu.assertAlmostEquals((net.x[node] - px) ^ 2 + (net.y[node] - py) ^ 2, least, 1e-15)
  end
  lu.assertEquals(pairs_seen, #f)
  lu.assertEquals(pairs_seen, #auxin) -- nearest, at any distance: each has one
end

function testWithin()
  local auxin, net = field_of(4, 300)
  local near = {}
  for k = 1, #auxin do
    for i = 1, #net do
      if (net.x[i] - auxin.x[k]) ^ 2 + (net.y[i] - auxin.y[k]) ^ 2 < 0.1 ^ 2 then near[k] = true end
    end
  end
  local seen = {}
  for attractor in auxin:influence(net, {within = 0.1}):pairs() do seen[attractor] = true end
  lu.assertEquals(seen, near)
end

local STALE = "this influence is out of date: call influence() again after anything has changed"

function testAStaleInfluenceIsRefused()
  local auxin, net = venule.attractors {}, venule.network {}
  net:root(0, 0)
  auxin:add(1, 0)
  auxin:add(0, 5)
  local f = auxin:influence(net)
  lu.assertEquals(#f, 2)
  lu.assertEquals({net:extend(f, {length = 0.5})}, {1, 2})
  fails(function() f:pairs() end, STALE)
  local ok, err = pcall(net.extend, net, f, {length = 0.5})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "this influence is out of date")
  f = auxin:influence(net)
  f:pairs()
  auxin:add(9, 9)
  fails(function() f:pairs() end, STALE)
  f = auxin:influence(net)
  net:root(3, 3)
  fails(function() f:pairs() end, STALE)
  f = auxin:influence(net)
  auxin:consume(net, {distance = 1e-6}) -- takes none: nothing has changed
  lu.assertEquals(#f, 3)
end

function testAnInfluenceMayNotChangeUnderALoop()
  local auxin, net = venule.attractors {}, venule.network {}
  net:root(0, 0)
  auxin:add(1, 0)
  auxin:add(0, 5)
  local f = auxin:influence(net)
  local ok, err = pcall(function()
    for attractor in f:pairs() do auxin:add(attractor, 7) end
  end)
  lu.assertFalse(ok)
  lu.assertStrContains(err, STALE)
end

function testAnInfluenceOutlivesWhatItLooksAt()
  local function make()
    local auxin, net = venule.attractors {}, venule.network {}
    net:root(0, 0)
    auxin:add(1, 0)
    return auxin:influence(net), auxin, net
  end
  local f = make()
  collectgarbage()
  collectgarbage()
  for attractor, node in f:pairs() do lu.assertEquals({attractor, node}, {1, 1}) end
  local g, auxin = make()
  auxin:close()
  fails(function() g:pairs() end, "this attractors is closed")
end

-- Equation 1 of the paper: the mean of the unit vectors, not of the vectors.
function testTheDirectionIsTheMeanOfUnitVectors()
  local auxin, net = venule.attractors {}, venule.network {}
  net:root(0, 0)
  auxin:add(10, 0)
  auxin:add(0, 1)
  net:extend(auxin:influence(net), {length = 2})
  lu.assertAlmostEquals(net.x[2], math.sqrt(2), 1e-12)
  lu.assertAlmostEquals(net.y[2], math.sqrt(2), 1e-12)
end

-- Attractors.

function testThrowCounts()
  local auxin, rng = venule.attractors {}, venule.rng(5)
  lu.assertEquals(auxin:throw {domain = domain.disk {}, count = 100, rng = rng}, 100)
  lu.assertEquals(#auxin, 100)
  local accepted = auxin:throw {domain = domain.disk {}, count = 5000, spacing = 0.1, rng = rng}
  lu.assertEquals(#auxin, 100 + accepted)
  lu.assertTrue(accepted > 20 and accepted < 1000)
  for i = 101, #auxin do
    for j = 1, i - 1 do
      local d2 = (auxin.x[i] - auxin.x[j]) ^ 2 + (auxin.y[i] - auxin.y[j]) ^ 2
      lu.assertTrue(d2 > 0.1 ^ 2, ("attractors %d and %d are too near"):format(i, j))
    end
    lu.assertTrue(auxin.x[i] ^ 2 + auxin.y[i] ^ 2 < 1)
  end
end

function testAFractionOfADartIsCarried()
  local auxin, rng, box = venule.attractors {}, venule.rng(5), domain.box {min = {0, 0}, max = {1, 1}}
  local counts = {}
  for i = 1, 8 do counts[i] = auxin:throw {domain = box, density = 0.25, rng = rng} end
  lu.assertEquals(counts, {0, 0, 0, 1, 0, 0, 0, 1})
end

function testClearance()
  local auxin, net, rng = venule.attractors {}, venule.network {}, venule.rng(5)
  net:root(0, 0)
  net:add(1, 0.5, 0)
  auxin:throw {domain = domain.disk {}, count = 500, clearance = 0.4, network = net, rng = rng}
  lu.assertTrue(#auxin > 100 and #auxin < 500)
  for k = 1, #auxin do
    for i = 1, 2 do
      lu.assertTrue((auxin.x[k] - net.x[i]) ^ 2 + (auxin.y[k] - net.y[i]) ^ 2 > 0.4 ^ 2)
    end
  end
end

function testViewsOfAttractorsAndConsume()
  local auxin, net, eaten = venule.attractors {}, venule.network {}, venule.attractors {}
  for i = 1, 10 do auxin:add(i, 2 * i) end
  local x, y = auxin.x, auxin.y
  lu.assertEquals({#x, x[10], y[10], x[11]}, {10, 10, 20})
  net:root(3, 6)
  lu.assertEquals(auxin:consume(net, {distance = 0.5, into = eaten}), 1)
  lu.assertEquals({#x, #auxin, x[2], x[3], x[9], x[10]}, {9, 9, 2, 4, 10})
  lu.assertEquals({#eaten, eaten.x[1], eaten.y[1]}, {1, 3, 6})
  lu.assertEquals(auxin:consume(net, {distance = 0.5}), 0)
  lu.assertEquals(auxin:consume(net, {distance = 1e3}), 9)
  lu.assertEquals(#x, 0)
  lu.assertNil(x[1])
end

-- "Closer than", not "as close as".
function testConsumeIsStrict()
  local auxin, net = venule.attractors {}, venule.network {}
  auxin:add(2, 0)
  net:root(0, 0)
  lu.assertEquals(auxin:consume(net, {distance = 2}), 0)
  lu.assertEquals(auxin:consume(net, {distance = 2 + 1e-9}), 1)
end

local function run_to_the_end(auxin, net, shape, length, kill)
  local steps = 0
  while #auxin > 0 do
    local added = net:extend(auxin:influence(net), {length = length, domain = shape})
    local eaten = auxin:consume(net, {distance = kill})
    steps = steps + 1
    lu.assertTrue(steps < 5000, "the run does not end")
    if added == 0 and eaten == 0 then break end
  end
end

function testHiddenSourcesAreRetired()
  local walls = domain.polygon {{0, 0}, {10, 0}, {10, 10}, {6, 10}, {6, 4}, {4, 4}, {4, 10}, {0, 10}}
  local rooms = domain.polygon {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}, {{6, 0}, {9, 0}, {9, 3}, {6, 3}}}
  local auxin, net = venule.attractors {}, venule.network {}
  auxin:add(7, 1)
  auxin:add(3, 3)
  net:root(1, 1)
  run_to_the_end(auxin, net, rooms, 0.5, 0.4)
  lu.assertEquals(#auxin, 0)
  lu.assertEquals(auxin.retired, {hidden = 1, circled = 0, barred = 0})
  -- round a corner nothing is hidden for ever: a third source leads a vein to where the second is seen
  auxin, net = venule.attractors {}, venule.network {}
  auxin:add(8, 9)
  auxin:add(8, 1)
  net:root(1, 1)
  run_to_the_end(auxin, net, walls, 0.5, 0.4)
  lu.assertEquals(#auxin, 0)
  lu.assertEquals(auxin.retired, {hidden = 0, circled = 0, barred = 0})
  for i = 1, #net do lu.assertTrue(walls:distance(net.x[i], net.y[i]) >= -1e-8) end
end

-- Segments too long for the kill distance: a source is either left to a vein that cannot step nearer, or circled and retired.
function testSourcesThatVeinsCannotReachDoNotGoOnForEver()
  for seed = 1, 20 do
    local auxin, net = venule.attractors {}, venule.network {}
    auxin:throw {domain = domain.disk {}, count = 5, rng = venule.rng(seed)}
    net:root(0, 0)
    run_to_the_end(auxin, net, nil, 1, 0.01)
    lu.assertEquals(#auxin + auxin.retired.circled, 5)
    lu.assertEquals(auxin.retired.hidden, 0)
    lu.assertTrue(#net < 1000)
  end
end

function testARootOutsideTheDomain()
  local auxin, net = venule.attractors {}, venule.network {}
  net:root(3, 0)
  auxin:add(0, 0)
  local f = auxin:influence(net)
  fails(function() net:extend(f, {length = 1, domain = domain.disk {}}) end, "extend: the root at (3, 0, 0) is outside the domain, by 2: place it inside or on the border")
end

-- Growth.

function testFieldsOfAGrowth()
  local blade = growth.marginal {domain = notched(), from = 20, to = 50, step = 10}
  lu.assertEquals({blade.time, blade.length, blade.final_length, blade.unit, blade.dim}, {0, 20, 50, 1, 2})
  lu.assertEquals(blade.origin, {0, 0})
  lu.assertEquals({blade:map(3, 4, 0, 2)}, {3, 4})
  lu.assertEquals(blade:bounds(), {min = {-6, 0}, max = {6, 20}})
  local lengths, moves = {}, {}
  for i = 1, 4 do moves[i], lengths[i] = blade:advance(), blade.length end
  lu.assertEquals(moves, {true, true, true, false})
  lu.assertEquals(lengths, {30, 40, 50, 50})
  lu.assertEquals(blade.time, 3)
  local still = growth.none {domain = notched()}
  lu.assertFalse(still:advance())
  lu.assertEquals({still.time, still.length, still.unit}, {0, 100, 1})
end

function testMarginalGrowthScalesAboutItsOrigin()
  local whole = notched()
  local blade = growth.marginal {domain = whole, origin = {0, 0}, from = 40, to = 100}
  lu.assertAlmostEquals(blade:measure(), whole:measure() * 0.16, 1e-9)
  for _, p in ipairs {{5, 10}, {30, 50}, {-22.5, 45}, {0, 99}, {0, 101}, {25, 60}, {24, 47}} do
    lu.assertEquals(blade:contains(0.4 * p[1], 0.4 * p[2]), whole:contains(p[1], p[2]))
    lu.assertAlmostEquals(blade:distance(0.4 * p[1], 0.4 * p[2]), 0.4 * whole:distance(p[1], p[2]), 1e-9)
  end
end

function testABladeThatGrowthWouldErode()
  local hook = domain.polygon {{0, 0}, {20, 0}, {20, 20}, {5, 20}, {5, 15}, {15, 15}, {15, 5}, {0, 5}}
  local ok, err = pcall(growth.marginal, {domain = hook})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "growth would erode it")
  lu.assertStrContains(err, "origin")
  lu.assertNotStrContains(err, "\n")
end

-- Domains.

function testCombinations()
  local a, b = domain.box {min = {0, 0}, max = {4, 4}}, domain.box {min = {2, 2}, max = {6, 6}}
  lu.assertAlmostEquals((a + b):measure(), 28, 1e-9)
  lu.assertAlmostEquals((a - b):measure(), 12, 1e-9)
  lu.assertAlmostEquals((a * b):measure(), 4, 1e-9)
  lu.assertEquals((a - b):bounds(), {min = {0, 0}, max = {4, 4}})
  for x = -0.5, 6.5, 0.5 do
    for y = -0.25, 6.5, 0.5 do
      local in_a, in_b = a:contains(x, y), b:contains(x, y)
      local on_border = a:distance(x, y) == 0 or b:distance(x, y) == 0
      if not on_border then
        lu.assertEquals((a + b):contains(x, y), in_a or in_b)
        lu.assertEquals((a - b):contains(x, y), in_a and not in_b)
        lu.assertEquals((a * b):contains(x, y), in_a and in_b)
      end
    end
  end
  fails(function() local _ = a - 3 end, "bad argument #2 to 'sub' (domain expected, got number)")
end

function testAGrowthIsADomain()
  local blade = growth.none {domain = domain.box {min = {0, 0}, max = {4, 4}}}
  local hole = domain.disk {center = {2, 2}, radius = 1}
  local rest = blade - hole
  lu.assertAlmostEquals(rest:measure(), 16 - math.pi, 1e-3)
  lu.assertFalse(rest:contains(2, 2))
  lu.assertTrue(rest:contains(0.5, 0.5))
  lu.assertAlmostEquals((hole * blade):measure(), math.pi, 1e-3)
  lu.assertAlmostEquals((hole + blade):measure(), 16, 1e-3)
  lu.assertEquals(#blade:sample(20, {rng = venule.rng(1)}), 20)
  local growing = growth.marginal {domain = notched(), from = 50, to = 100}
  lu.assertAlmostEquals((growing + growing):measure(), growing:measure(), 1e-6)
  local cut = growing - domain.disk {center = {0, 40}, radius = 5}
  repeat
    lu.assertTrue(cut:measure() <= growing:measure() * (1 + 1e-9))
    lu.assertTrue(growing:measure() - cut:measure() <= math.pi * 25 * (1 + 1e-4))
    for k = 1, 2 do
      lu.assertAlmostEquals(cut:bounds().max[k], growing:bounds().max[k], 1e-6)
    end
  until not growing:advance()
  lu.assertAlmostEquals(growing:measure() - cut:measure(), math.pi * 25, 1e-2)
end

function testCombinationsOutliveTheirParts()
  local rest = domain.box {min = {0, 0}, max = {4, 4}} - domain.disk {center = {2, 2}}
  collectgarbage()
  collectgarbage()
  lu.assertFalse(rest:contains(2, 2))
  lu.assertTrue(rest:contains(0.1, 0.1))
end

function testSvgByIdAndPick()
  local largest = domain.svg(FILES .. "inkscape.svg")
  lu.assertAlmostEquals(largest:measure(), 1200, 1e-6)
  lu.assertEquals(largest.unit, "mm")
  lu.assertEquals(largest:bounds(), {min = {20, 30}, max = {60, 60}, unit = "mm"})
  lu.assertAlmostEquals(domain.svg(FILES .. "inkscape.svg", {id = "small"}):measure(), 25, 1e-6)
  lu.assertAlmostEquals(domain.svg(FILES .. "inkscape.svg", {id = "layer1"}):measure(), 1225, 1e-6)
  lu.assertAlmostEquals(domain.svg(FILES .. "inkscape.svg", {pick = "all"}):measure(), 1225, 1e-6)
  local ok, err = pcall(domain.svg, FILES .. "inkscape.svg", {id = "bladd"})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "bladd")
  lu.assertStrContains(err, "inkscape.svg")
end

function testSample()
  local shape = notched()
  local points = shape:sample(2000, {spacing = 3, rng = venule.rng(9)})
  lu.assertTrue(#points > 100 and #points < 2000)
  for i, p in ipairs(points) do
    lu.assertTrue(shape:contains(p[1], p[2]))
    for j = 1, i - 1 do
      lu.assertTrue((p[1] - points[j][1]) ^ 2 + (p[2] - points[j][2]) ^ 2 > 9)
    end
  end
  lu.assertEquals(shape:sample(2000, {spacing = 3, rng = venule.rng(9)}), points)
  lu.assertEquals(#shape:sample(50, {rng = venule.rng(9)}), 50)
  local ball = domain.sphere {radius = 2}:sample(20, {rng = venule.rng(9)})
  lu.assertEquals({#ball, #ball[1]}, {20, 3})
end

-- Half of the darts must fall into each half: 4 standard deviations are allowed.
function testSamplesAreUniform()
  local shape = domain.disk {}
  local left, lower, inner, n = 0, 0, 0, 20000
  for _, p in ipairs(shape:sample(n, {rng = venule.rng(9)})) do
    left = left + (p[1] < 0 and 1 or 0)
    lower = lower + (p[2] < 0 and 1 or 0)
    inner = inner + (p[1] ^ 2 + p[2] ^ 2 < 0.5 and 1 or 0)
  end
  local margin = 4 * math.sqrt(n) / 2
  for _, count in ipairs {left, lower, inner} do lu.assertAlmostEquals(count, n / 2, margin) end
end

function testAViewBringsItsUnit()
  local leaf = domain.svg(FILES .. "inkscape.svg")
  local page = venule.canvas {view = leaf:bounds(), width = 500, margin = 0}
  lu.assertEquals({page.width, page.height}, {500, 375}) -- 40 x 30 mm
  lu.assertAlmostEquals(page.scale, 12.5, 1e-9)
end

-- Venation, the same loop in a file of its own.

local function leaf(o)
  o.domain = o.domain or growth.marginal {domain = notched(), from = 10, to = 100, step = 5}
  o.rng, o.darts, o.birth_distance = venule.rng(1), 0.05, 4
  return venule.venation(o)
end

local function notes_of(run)
  local notes, before = {}, venule.note
  venule.note = function(text) notes[#notes + 1] = text end
  local ok, err = pcall(run)
  venule.note = before
  lu.assertTrue(ok, err)
  return notes
end

function testVenationEnds()
  local s, steps = leaf {kill_distance = 2}, 0
  local notes = notes_of(function() s:run {progress = function(system)
    lu.assertTrue(system == s)
    steps = steps + 1
  end} end)
  lu.assertEquals(notes, {})
  lu.assertEquals(#s.attractors, 0)
  lu.assertTrue(steps >= 18)
  lu.assertTrue(#s.network > 200)
  lu.assertFalse(s:step()) -- done stays done
end

function testVenationOnAStillDomainEnds()
  local s = leaf {domain = notched(), kill_distance = 2, roots = {{0, 1}, {0, 99}}}
  lu.assertEquals(notes_of(function() s:run() end), {})
  lu.assertEquals(s.network:measure().roots, 2)
end

function testAStallIsReportedAndEnds()
  local s = leaf {kill_distance = 0.5, attraction_distance = 0.75}
  local notes = notes_of(function() s:run() end)
  lu.assertEquals(#notes, 1)
  lu.assertStrContains(notes[1], ("stalled with %d attractors left: no node is within their reach"):format(#s.attractors))
  lu.assertTrue(#s.attractors > 1)
end

function testCirclingIsReported()
  local s = leaf {kill_distance = 0.01, segment_length = 3}
  local notes = notes_of(function() s:run() end)
  local last = notes[#notes] -- some may be hidden or left over, too
  lu.assertStrMatches(last, "%d+ sources? given up: no vein came nearer to them, as segment_length = 3 is long for kill_distance = 0.01")
  lu.assertTrue(s.attractors.retired.circled > 0)
end

-- Without the program around it, a note goes to stderr.
function testNotesGoToStderr()
  local said, stderr = {}, io.stderr
  io.stderr = {write = function(_, ...) said[#said + 1] = table.concat {...} end}
  local ok, err = pcall(function() leaf {kill_distance = 0.5, attraction_distance = 0.75}:run() end)
  io.stderr = stderr
  lu.assertTrue(ok, err)
  lu.assertEquals(#said, 1)
  lu.assertStrMatches(said[1], "note: stalled with %d+ attractors left.*\n")
end

function testGrownStopsEarly()
  local s = leaf {kill_distance = 2, stop = "grown"}
  local notes = notes_of(function() s:run() end)
  lu.assertEquals(notes, {})
  lu.assertEquals(s.blade.length, 100)
end
