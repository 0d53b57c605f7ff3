-- What Runions et al. 2005 leave open: veinlets that end freely within areoles, and loops of secondary veins.
local venule = require "venule"
local lu = require "luaunit"

local function blade() return venule.leaf.entire {length = 160, width = 80} end

local function closed(o)
  local given = {
    domain = blade(), rng = venule.rng(o.seed or 1), roots = {{0, 0}}, birth_distance = 10, darts = 0.002,
    neighborhood = "relative", veinlets = o.veinlets,
  }
  return venule.venation(given):run()
end

local function measure(network) return network:measure {leaf = true, domain = blade()}.leaf end

-- Whether p-q and r-s cross, by the signs of four areas.
local function side(ax, ay, bx, by, x, y) return (bx - ax) * (y - ay) - (by - ay) * (x - ax) end

local function cross(p, q, r, s)
  return side(p[1], p[2], q[1], q[2], r[1], r[2]) * side(p[1], p[2], q[1], q[2], s[1], s[2]) < 0
    and side(r[1], r[2], s[1], s[2], p[1], p[2]) * side(r[1], r[2], s[1], s[2], q[1], q[2]) < 0
end

-- Edges from node `from` on against all: every pair is looked at.
local function crossings(net, from)
  local x, y, parent, count = net.x, net.y, net.parent, 0
  local place = {}
  for i = 1, #net do place[i] = {x[i], y[i]} end
  for i = from, #net do
    for j = 1, i - 1 do
      local p, q = parent[i], parent[j]
      if q > 0 and math.abs(place[i][1] - place[j][1]) < 5 and cross(place[p], place[i], place[q], place[j]) then count = count + 1 end
    end
  end
  return count
end

function testVeinletsEndFreelyAndCloseNoLoop()
  for seed = 1, 3 do
    local net = closed {seed = seed}.network
    local before, nodes, joins = measure(net), #net, #net:joins()
    local left = venule.veinlets {network = net, domain = blade(), rng = venule.rng(seed), birth_distance = 8}
    local after = measure(net)
    lu.assertEquals(#left, 0)
    lu.assertTrue(before.areoles > 10)
    lu.assertEquals(after.areoles, before.areoles)
    lu.assertEquals(after.loops, before.loops)
    lu.assertEquals(#net:joins(), joins)
    lu.assertEquals(after.crossings, 0)
    lu.assertEquals(crossings(net, nodes + 1), 0)
    lu.assertTrue(before.free_ends < 0.9 * before.areoles, before.free_ends .. " free ends before, in " .. before.areoles .. " areoles")
    lu.assertTrue(after.free_ends > before.areoles and after.free_ends < 3.5 * before.areoles, after.free_ends .. " free ends")
  end
end

-- As an option of the venation they are the same veinlets, and come last.
function testVeinletsAsAnOption()
  local s = closed {veinlets = {birth_distance = 8}}
  local plain = closed {}.network
  lu.assertTrue(#s.network > #plain + 100)
  lu.assertEquals(#s.network:joins(), #plain:joins())
  for i = 1, #plain do
    lu.assertEquals(s.network.x[i], plain.x[i])
    lu.assertEquals(s.network.y[i], plain.y[i])
  end
  lu.assertEquals(measure(s.network).areoles, measure(plain).areoles)
  lu.assertEquals(#s.veinlets, 0)
end

-- Under isogonic growth all lengths shrink with the blade's unit, those of veinlets too.
function testVeinletsFollowTheUnit()
  local function leaf(veinlets)
    local s = venule.venation {
      domain = venule.growth.isogonic {domain = blade(), origin = {0, 0}, from = 20, to = 160, step = 4}, rng = venule.rng(1),
      roots = {{0, 0}}, birth_distance = 6, darts = 0.01, neighborhood = "relative", veinlets = veinlets,
    }
    return s, s:run().network
  end
  local s, net = leaf {birth_distance = 4, segment_length = 0.5}
  local _, plain = leaf()
  local unit, p = s.blade.unit, net.parent
  lu.assertTrue(unit < 0.5)
  lu.assertTrue(#net > #plain)
  for i = #plain + 1, #net do
    local dx, dy = net.x[i] - net.x[p[i]], net.y[i] - net.y[p[i]]
    lu.assertAlmostEquals(math.sqrt(dx * dx + dy * dy), 0.5 * unit, 1e-9)
  end
end

function testMisspelledVeinlets()
  local ok, err = pcall(closed, {veinlets = {birth_distanc = 8}})
  lu.assertFalse(ok)
  lu.assertStrContains(err, 'venation.veinlets: unknown field "birth_distanc", did you mean "birth_distance"?')
end

-- Brochidodromous venation

local function loops_of(o)
  local given = {domain = venule.leaf.entire {length = 400, width = 170}, rng = venule.rng(1)}
  for key, value in pairs(o) do given[key] = value end
  return venule.brochidodromous(given)
end

-- Which secondary a node belongs to: the height at which its way down leaves the midvein, and the side.
local function foot_of(net, node)
  local x, y, parent = net.x, net.y, net.parent
  local side = x[node] > 0 and 1 or -1
  while math.abs(x[node]) > 1e-9 do node = parent[node] end
  return side, y[node]
end

-- Every join closes a cycle through the midvein and two secondaries; from base to tip these follow each other.
function testConsecutiveSecondariesAreJoinedOnBothSides()
  for _, n in ipairs {2, 7, 14} do
    for seed = 1, 4 do
      local s = loops_of {secondaries = n, rng = venule.rng(seed)}
      local feet = {[1] = {}, [-1] = {}}
      local pairs_joined = {[1] = {}, [-1] = {}}
      for _, join in ipairs(s.network:joins()) do
        local side, a = foot_of(s.network, join.a)
        local other, b = foot_of(s.network, join.b)
        lu.assertEquals(side, other)
        feet[side][a], feet[side][b] = true, true
        table.insert(pairs_joined[side], {math.min(a, b), math.max(a, b)})
      end
      for side = -1, 1, 2 do
        local heights = {}
        for y in pairs(feet[side]) do heights[#heights + 1] = y end
        table.sort(heights)
        table.sort(pairs_joined[side], function(p, q) return p[1] < q[1] end)
        lu.assertEquals(#heights, n)
        lu.assertEquals(#pairs_joined[side], n - 1)
        for k, pair in ipairs(pairs_joined[side]) do lu.assertEquals(pair, {heights[k], heights[k + 1]}) end
      end
      lu.assertEquals(s.arches, 2 * n - 2)
      local m = s.network:measure {leaf = true}.leaf
      lu.assertEquals({m.areoles, m.crossings}, {2 * n - 2, 0})
    end
  end
end

-- Where half of the blade's width ends at a height, by its outline.
local function width_at(y)
  local points, most = venule.leaf.outline("entire", {length = 400, width = 170}), 0
  for i, p in ipairs(points) do
    local q = points[i % #points + 1]
    if (p[2] - y) * (q[2] - y) <= 0 and p[2] ~= q[2] then
      most = math.max(most, math.abs(p[1] + (y - p[2]) / (q[2] - p[2]) * (q[1] - p[1])))
    end
  end
  return most
end

function testSecondariesDoNotReachTheMargin()
  local net, most = loops_of {reach = 0.75}.network, 0
  for i = 1, #net do
    if net.y[i] < 350 then most = math.max(most, math.abs(net.x[i]) / width_at(net.y[i])) end
  end
  lu.assertTrue(most > 0.72 and most < 0.78, "they reach " .. most)
end

-- Finer veins leave the arches as they are.
function testArchesStayWhenTheRestIsFilled()
  local s = loops_of {secondaries = 5}
  local joins = s.network:joins()
  venule.venation {
    domain = s.options.domain, network = s.network, rng = venule.rng(2), neighborhood = "relative", birth_distance = 12, darts = 0.002,
  }:run()
  for i, join in ipairs(joins) do
    lu.assertEquals(s.network:joins()[i].a, join.a)
    lu.assertEquals(s.network:joins()[i].b, join.b)
  end
  local m = s.network:measure {leaf = true}.leaf
  lu.assertTrue(m.areoles > 60)
  lu.assertEquals(m.crossings, 0)
end

function testTooManySecondariesAreSaid()
  local notes, note = {}, venule.note
  venule.note = function(text) notes[#notes + 1] = text end
  local ok, s = pcall(loops_of, {secondaries = 200})
  venule.note = note
  lu.assertTrue(ok, s)
  lu.assertStrMatches(notes[1], "brochidodromous: %d+ of 398 pairs of secondaries are joined: too many for segments as long as these")
end
