-- Networks that keep clear of each other, as a script asks for it.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

-- A network from a root, and attractors for it.
local function tree(dim, x, y)
  local t = {
    net = venule.network {dim = dim, murray = {exponent = 2.6, tip_radius = 0.002}},
    drains = venule.attractors {dim = dim},
  }
  t.net:root(x, y, dim == 3 and 0 or nil)
  return t
end

local function step(t, domain, rng, avoid)
  t.drains:throw {domain = domain, count = 60, spacing = 0.06, clearance = 0.06, network = t.net, rng = rng}
  local added = t.net:extend(t.drains:influence(t.net, {within = 0.5, perception = {angle = 120}}),
    {length = 0.05, domain = domain, bias = 0.4, bias_mean = true, bifurcate = 20, avoid = avoid})
  t.drains:consume(t.net, {distance = 0.05})
  return added
end

-- Segments p q and r s in the plane.
local function crosses(net, i, other, j)
  local function turn(ax, ay, bx, by, cx, cy) return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) > 0 end
  local p, r = net.parent[i], other.parent[j]
  if p == 0 or r == 0 then return false end
  local ax, ay, bx, by = net.x[p], net.y[p], net.x[i], net.y[i]
  local cx, cy, dx, dy = other.x[r], other.y[r], other.x[j], other.y[j]
  return turn(ax, ay, bx, by, cx, cy) ~= turn(ax, ay, bx, by, dx, dy) and
    turn(cx, cy, dx, dy, ax, ay) ~= turn(cx, cy, dx, dy, bx, by)
end

local function crossings(net, other)
  local count = 0
  for i = 1, #net do
    for j = 1, #other do count = count + (crosses(net, i, other, j) and 1 or 0) end
  end
  return count
end

local function grow(avoid)
  local disk, rng = venule.domain.disk {radius = 0.5}, venule.rng(4)
  local a, v = tree(2, -0.5, 0), tree(2, 0.5, 0)
  for _ = 1, 40 do
    step(a, disk, rng, avoid and v.net or nil)
    step(v, disk, rng, avoid and {a.net} or nil)
  end
  return a, v
end

function testArteriesAndVeinsDoNotCross()
  local a, v = grow(true)
  lu.assertEquals(crossings(a.net, v.net), 0)
  lu.assertTrue(#a.net > 60 and #v.net > 60)
  lu.assertTrue(a.drains.retired.barred + v.drains.retired.barred > 0)
  a, v = grow(false)
  lu.assertTrue(crossings(a.net, v.net) > 0)
end

function testAvoidInSpace()
  local ball, rng = venule.domain.sphere {radius = 0.5}, venule.rng(4)
  local a, v, w = tree(3, -0.5, 0), tree(3, 0.5, 0), tree(3, 0, 0.5)
  for _ = 1, 10 do
    step(a, ball, rng, {v.net, w.net})
    step(v, ball, rng, {a.net, w.net})
    step(w, ball, rng, {a.net, v.net})
  end
  lu.assertTrue(#a.net > 20 and #v.net > 20 and #w.net > 20)
end

function testWhatCannotBeAvoided()
  local disk, rng = venule.domain.disk {radius = 0.5}, venule.rng(4)
  local a, v = tree(2, -0.5, 0), tree(2, 0.5, 0)
  fails(function() step(a, disk, rng, a.net) end, "cannot avoid itself")
  fails(function() step(a, disk, rng, {v.net, a.net}) end, "cannot avoid itself")
  fails(function() step(a, disk, rng, venule.network {dim = 3}) end, "2 dimensions cannot avoid one of 3")
  fails(function() step(a, disk, rng, 7) end, "a network or a list {a, b, …} of them expected, got a number")
  fails(function() step(a, disk, rng, {v.net, "v"}) end, "got a string")
  fails(function() step(a, disk, rng, {veins = v.net}) end, "not a table with names")
  fails(function() step(a, disk, rng, disk) end, "network expected")
  local many = {}
  for i = 1, 17 do many[i] = v.net end
  fails(function() step(a, disk, rng, many) end, "at most 16")
  local closed <close> = venule.network {}
  do local gone <close> = closed end
  fails(function() step(a, disk, rng, closed) end, "closed")
  fails(function() a.net:extend(a.drains:influence(a.net), {length = 0.1, gap = 0.1}) end, "extend.gap")
  lu.assertTrue(step(a, disk, rng, {}) >= 0)
end
