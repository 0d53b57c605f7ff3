-- What Rauch & Harders 2021 say of their parameters (section 4, Figure 5), measured on several trees each.
local venule = require "venule"
local lu = require "luaunit"

local SEEDS = 5

-- The disk of Figure 5, a little smaller: 60 steps.
local function grow(seed, change)
  local o = {
    domain = venule.domain.disk {radius = 0.5}, rng = venule.rng(seed), steps = 60, segment_length = 0.022,
    arteries = {roots = {{-0.5, 0}}},
  }
  for name, value in pairs(change) do o[name] = value end
  local s = venule.vessels(o):run()
  lu.assertTrue(#s.arteries > 200, #s.arteries)
  return s.arteries, s
end

local function direction(net, i)
  local p = net.parent[i]
  return math.atan(net.y[i] - net.y[p], net.x[i] - net.x[p])
end

local function between(a, b)
  local d = math.abs(a - b) % (2 * math.pi)
  return math.deg(math.min(d, 2 * math.pi - d))
end

local function each_fork(net, visit)
  for i = 1, #net do
    local c = net:children(i)
    if #c == 2 then visit(c[1], c[2]) end
  end
end

-- Mean angle between the daughters of a fork, in degrees.
local function fork_angle(net)
  local sum, count = 0, 0
  each_fork(net, function(a, b) sum, count = sum + between(direction(net, a), direction(net, b)), count + 1 end)
  return sum / count
end

-- Mean angle by which a vessel turns at a node where it does not fork, in degrees.
local function turning(net)
  local sum, count = 0, 0
  for i = 1, #net do
    local c = net:children(i)
    if net.parent[i] > 0 and #c == 1 then
      sum, count = sum + between(direction(net, i), direction(net, c[1])), count + 1
    end
  end
  return sum / count
end

-- Mean arc by chord of the vessels between two forks, or a fork and a tip, of five segments or more.
local function tortuosity(net)
  local sum, count = 0, 0
  for i = 1, #net do
    if #net:children(i) ~= 1 and net.parent[i] > 0 then
      local j, arc, segments = i, 0, 0
      repeat
        local p = net.parent[j]
        arc, segments = arc + math.sqrt((net.x[j] - net.x[p]) ^ 2 + (net.y[j] - net.y[p]) ^ 2), segments + 1
        j = p
      until net.parent[j] == 0 or #net:children(j) > 1
      if segments >= 5 then
        sum, count = sum + arc / math.sqrt((net.x[i] - net.x[j]) ^ 2 + (net.y[i] - net.y[j]) ^ 2), count + 1
      end
    end
  end
  return sum / count
end

-- Daughters of a symmetric fork are born together, a lateral comes later than what it leaves.
local function forks(net)
  local symmetric, lateral = 0, 0
  each_fork(net, function(a, b)
    if net.birth[a] == net.birth[b] then symmetric = symmetric + 1 else lateral = lateral + 1 end
  end)
  return symmetric, lateral
end

local function lateral_share(net)
  local symmetric, lateral = forks(net)
  return lateral / (symmetric + lateral)
end

-- measure(changed) - measure(as it is) of tree after tree, which is at least `least` on the mean and of one sign.
local function check_rise(name, value, measure, least)
  local sum, list = 0, {}
  for seed = 1, SEEDS do
    local rise = measure(grow(seed, {[name] = value})) - measure(grow(seed, {}))
    sum, list[seed] = sum + rise, ("%.4g"):format(rise)
    lu.assertTrue(rise * least > 0, ("%s = %g: %s"):format(name, value, table.concat(list, " ")))
  end
  local mean = sum / SEEDS
  lu.assertTrue(math.abs(mean) >= math.abs(least), ("%s = %g: %s, mean %.4g"):format(name, value, table.concat(list, " "), mean))
end

function testLargerKappaWidensAngles()
  check_rise("murray_exponent", 3.6, fork_angle, 14)
end

function testLargerOmegaStraightens()
  check_rise("bias", 0.9, turning, -5)
  check_rise("bias", 0.9, tortuosity, -0.012)
end

function testLargerPhiGivesMoreLaterals()
  check_rise("bifurcation_threshold", 30, lateral_share, 0.35)
end

function testWhatIsSwitchedOffDoesNotHappen()
  for seed = 1, SEEDS do
    local symmetric, lateral = forks((grow(seed, {lateral = false})))
    lu.assertEquals(lateral, 0)
    lu.assertTrue(symmetric > 50)
    symmetric, lateral = forks((grow(seed, {bifurcate = false})))
    lu.assertEquals(symmetric, 0)
    lu.assertTrue(lateral > 50)
  end
end

-- Without growth every segment is as long as the first; with it the last are shorter by λ.
function testWithoutGrowthLengthsStay()
  local function lengths(net)
    local low, high = math.huge, 0
    for i = 1, #net do
      local p = net.parent[i]
      if p > 0 then
        local length = math.sqrt((net.x[i] - net.x[p]) ^ 2 + (net.y[i] - net.y[p]) ^ 2)
        low, high = math.min(low, length), math.max(high, length)
      end
    end
    return low, high
  end
  local net, s = grow(1, {growth = 0})
  local low, high = lengths(net)
  lu.assertAlmostEquals(low, 0.022, 1e-12)
  lu.assertAlmostEquals(high, 0.022, 1e-12)
  lu.assertEquals(s.unit, 1)
  net, s = grow(1, {})
  low, high = lengths(net)
  lu.assertAlmostEquals(high, 0.022, 1e-12)
  lu.assertAlmostEquals(s.unit, 1 / (1 + 59 * 0.02), 1e-9)
  lu.assertAlmostEquals(low, 0.022 * s.unit, 1e-3 * low)
end

-- Parameters that ask for the artefacts of Figure 6 are named in a note; those of Figure 5 are not.
function testArtefactsAreAnnounced()
  local function notes(change)
    local said, note = {}, venule.note
    rawset(venule, "note", function(text) said[#said + 1] = text end)
    local ok, err = pcall(venule.vessels, change)
    rawset(venule, "note", note)
    lu.assertTrue(ok, err)
    return table.concat(said, "|")
  end
  local function given(change)
    local o = {domain = venule.domain.disk {radius = 0.5}, rng = venule.rng(1), arteries = {roots = {{-0.5, 0}}}}
    for name, value in pairs(change) do o[name] = value end
    return notes(o)
  end
  lu.assertEquals(given {}, "")
  lu.assertEquals(given {bias = 0.9, murray_exponent = 3.6, bifurcation_threshold = 30}, "")
  lu.assertStrContains(given {segment_length = 0.09}, "vessels overshoot their drains")
  lu.assertStrContains(given {perception_angle = 340}, "perception_angle = 340 is above 180")
  lu.assertStrContains(given {bias = 0.98}, "bias = 0.98 is above 0.9")
end

-- And one of them is counted: with too large a step vessels cross others far more often.
function testTooLargeStepsMakeVesselsCollide()
  local function crossings(net)
    local count = 0
    for i = 1, #net do
      for j = i + 1, #net do
        local a, b = net.parent[i], net.parent[j]
        if a > 0 and b > 0 and a ~= b and a ~= j and b ~= i then
          local ax, ay, bx, by = net.x[a], net.y[a], net.x[i], net.y[i]
          local cx, cy, dx, dy = net.x[b], net.y[b], net.x[j], net.y[j]
          local function side(px, py, qx, qy, rx, ry) return (qx - px) * (ry - py) - (qy - py) * (rx - px) end
          if side(ax, ay, bx, by, cx, cy) * side(ax, ay, bx, by, dx, dy) < 0 and
            side(cx, cy, dx, dy, ax, ay) * side(cx, cy, dx, dy, bx, by) < 0 then
            count = count + 1
          end
        end
      end
    end
    return count / #net
  end
  local fine = crossings((grow(1, {steps = 40})))
  local coarse = crossings((grow(1, {steps = 40, segment_length = 0.09})))
  lu.assertTrue(coarse > 10 * fine and coarse > 0.2, ("%g %g"):format(fine, coarse))
end
