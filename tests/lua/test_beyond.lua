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
