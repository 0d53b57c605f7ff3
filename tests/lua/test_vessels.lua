-- Vessels (Rauch & Harders 2021): options and their errors, both trees, stages, the switches, the same bytes again.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

local function system(more)
  local o = {
    domain = venule.domain.disk {radius = 0.5}, rng = venule.rng(3), steps = 40, darts = 1000,
    arteries = {roots = {{-0.5, 0}}}, veins = {roots = {{-0.49, -0.09}}, perception_distance = 0.2},
  }
  for key, value in pairs(more or {}) do o[key] = value end
  return venule.vessels(o)
end

local function forks_and_laterals(net)
  local children, laterals, forks = {}, 0, 0
  for i = 1, #net do
    local parent = net.parent[i]
    if parent > 0 then
      children[parent] = children[parent] or {}
      table.insert(children[parent], net.birth[i])
    end
  end
  for _, births in pairs(children) do
    if #births == 2 and births[1] == births[2] then forks = forks + 1 end
    if #births == 2 and births[1] ~= births[2] then laterals = laterals + 1 end
    lu.assertTrue(#births <= 2)
  end
  return forks, laterals
end

TestVessels = {}

function TestVessels:testBothTreesGrow()
  local s = system():run {}
  lu.assertTrue(#s.arteries > 60)
  lu.assertTrue(#s.veins > 30)
  lu.assertEquals(s.networks.arteries, s.arteries)
  lu.assertEquals(s.time, 40)
  local forks, laterals = forks_and_laterals(s.arteries)
  lu.assertTrue(forks > 3)
  lu.assertTrue(laterals > 3)
end

function TestVessels:testTheSameSeedGivesTheSame()
  local a, b = system():run {}, system():run {}
  lu.assertEquals(#a.arteries, #b.arteries)
  for i = 1, #a.arteries do
    lu.assertTrue(a.arteries.x[i] == b.arteries.x[i] and a.arteries.y[i] == b.arteries.y[i])
  end
end

function TestVessels:testLateralsAndForksAreSwitchedOff()
  local forks, laterals = forks_and_laterals(system {lateral = false}:run {}.arteries)
  lu.assertEquals(laterals, 0)
  lu.assertTrue(forks > 0)
  forks = forks_and_laterals(system {bifurcate = false}:run {}.arteries)
  lu.assertEquals(forks, 0)
end

function TestVessels:testTissueThatStays()
  local s = system {growth = 0}:run {}
  lu.assertEquals(s.unit, 1)
  lu.assertEquals(s.time, 40)
end

-- In every step lengths are those of its own unit.
function TestVessels:testSegmentsShrinkAsTheTissueGrows()
  local s = system()
  while true do
    local first, unit = #s.arteries + 1, s.unit
    local more = s:step()
    for i = first, #s.arteries do
      local p = s.arteries.parent[i]
      local length = math.sqrt((s.arteries.x[i] - s.arteries.x[p]) ^ 2 + (s.arteries.y[i] - s.arteries.y[p]) ^ 2)
      lu.assertAlmostEquals(length, 0.03 * unit, 1e-12)
    end
    if not more then break end
  end
  lu.assertAlmostEquals(s.unit, 1 / (1 + 39 * 0.02), 1e-12)
  lu.assertAlmostEquals(s.arteries.radius[#s.arteries], 0.0005 * s.unit, 1e-12)
end

function TestVessels:testStages()
  local s = system {stages = {{steps = 10, lateral = false}, {steps = 5, veins = {bias = 1}, segment_length = 0.01}}}
  s:run {}
  lu.assertEquals(s.steps, 15)
  lu.assertEquals(s.stage, 2)
  lu.assertEquals(s.stages[2].veins.bias, 1)
  lu.assertEquals(s.stages[2].arteries.bias, 0.5)
  lu.assertEquals(s.stages[2].arteries.segment_length, 0.01)
  lu.assertFalse(s.stages[1].arteries.lateral)
end

-- Roots of one kind share the drains; arteries may go on from what is there.
function TestVessels:testSeveralTreesAndMoreOfThem()
  local s = system {arteries = {roots = {{-0.5, 0}, {0.5, 0}, {0, 0.5}}}}:run {}
  local grew = {}
  for i = 1, #s.arteries do grew[s.arteries.tree and s.arteries.tree[i] or 1] = true end
  local more = system {arteries = {network = s.arteries}, steps = 60}
  local before = #s.arteries
  more:run {}
  lu.assertTrue(#more.arteries > before)
end

function TestVessels:testASolid()
  local s = venule.vessels {
    domain = venule.domain.sphere {radius = 0.5}, rng = venule.rng(1), steps = 25, density = 3000,
    arteries = {roots = {{-0.45, 0, 0, heading = {1, 0, 0}}}},
  }
  s:run {}
  lu.assertTrue(#s.arteries > 50)
  lu.assertNil(s.veins)
  local ball = venule.domain.sphere {radius = 0.5}
  for i = 1, #s.arteries do lu.assertTrue(ball:contains(s.arteries.x[i], s.arteries.y[i], s.arteries.z[i])) end
end

function TestVessels:testZones()
  local net = venule.network {murray = {exponent = 2.55}}
  local root = net:root(0, 0)
  lu.assertEquals(net:zone(root, {angle = 90}).kind, "ball")
  net:heading(root, 0, 1)
  lu.assertEquals(net:zone(root, {angle = 90}).kind, "cone")
  local a = net:add(root, 1, 0)
  lu.assertEquals(net:zone(root, {angle = 90}).kind, "none")
  lu.assertEquals(net:zone(a, {angle = 90}).direction, {1, 0})
  net:add(a, 2, 0)
  local belt = net:zone(a, {angle = 90})
  lu.assertEquals(belt.kind, "belt")
  lu.assertAlmostEquals(belt.angle, 30.5556, 5e-5)
  lu.assertEquals(net:zone(a, {angle = 90, lateral = false}).kind, "none")
end

function TestVessels:testErrors()
  fails(function() system {perception_distance = 0.02} end, "must be above satisfaction = 0.03")
  fails(function() system {murray_exponent = 5} end, "vessels.murray_exponent = 5 must be above 2 and at most 4")
  fails(function() system {arteries = {}} end, "vessels.arteries: give roots")
  fails(function() system {arteries = {roots = {{0, 0, 0}}}} end, "vessels.arteries.roots[1]: {x, y} expected")
  fails(function() system {arteries = {roots = {{-0.6, 0}}}}:run {} end, "the root at (-0.6, 0, 0) is outside the domain")
  fails(function() system {percption_angle = 3} end, 'did you mean "perception_angle"?')
  fails(function() system {stages = {{steps = 3, bios = 1}}} end, 'vessels.stages[1]: unknown field "bios", did you mean "bias"?')
  fails(function() system {density = 3} end, "give either `darts` or `density`")
  local net, a = venule.network {}, venule.attractors {}
  net:root(0, 0)
  a:add(0.1, 0)
  fails(function() a:influence(net, {perception = {angle = 90}}) end, "Murray's law")
  fails(function() a:influence(net, {perception = {angel = 90}}) end, 'did you mean "angle"?')
  fails(function() net:extend(a:influence(net), {length = 1, bias = 0.5}) end, "give the influence perception = {angle=}")
  fails(function() net:zone(7, {angle = 90}) end, "node 7")
end
