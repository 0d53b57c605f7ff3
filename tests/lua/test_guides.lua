-- Vessels that first follow the user's own paths (Rauch & Harders 2021, Figure 4).
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, ...)
  local ok, err = pcall(f)
  for _, message in ipairs {...} do
    lu.assertFalse(ok, "no error, where this was expected: " .. message)
    lu.assertStrContains(err, message)
  end
  lu.assertNil(tostring(err):find("\n", 1, true), err)
end

local function with_file(name, text, f)
  local path = os.tmpname() .. name
  local file = assert(io.open(path, "w"))
  file:write(text)
  file:close()
  local ok, err = pcall(f, path)
  os.remove(path)
  if not ok then error(err, 0) end
end

local disk = venule.domain.disk {radius = 0.5}

local function vessels(given)
  local o = {domain = disk, rng = venule.rng(1), steps = 30, segment_length = 0.022}
  for key, value in pairs(given) do o[key] = value end
  return venule.vessels(o)
end

local function distance_to(path, x, y)
  local best = math.huge
  for i = 2, #path do
    local ax, ay, dx, dy = path[i - 1][1], path[i - 1][2], path[i][1] - path[i - 1][1], path[i][2] - path[i - 1][2]
    local t = math.max(0, math.min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy)))
    best = math.min(best, math.sqrt((x - ax - t * dx) ^ 2 + (y - ay - t * dy) ^ 2))
  end
  return best
end

local function check_murray(net, exponent, tip)
  for i = 1, #net do
    local children, sum = net:children(i), 0
    for _, c in ipairs(children) do sum = sum + net.radius[c] ^ exponent end
    lu.assertTrue(#children <= 2)
    if net.parent[i] ~= 0 then
      lu.assertAlmostEquals(net.radius[i], #children == 0 and tip or sum ^ (1 / exponent), 1e-9 * net.radius[i])
    end
  end
end

local long, short = {{-0.5, 0}, {-0.2, 0.1}, {0.3, 0}}, {{-0.2, 0.1}, {-0.1, 0.4}}

function testVesselsBeginWithTheGuides()
  local s = vessels {arteries = {guides = {long, short}}}
  local net = s.arteries
  lu.assertEquals(net:measure().roots, 1)
  lu.assertEquals(net:measure().tips, 2)
  lu.assertEquals({net.x[1], net.y[1]}, {-0.5, 0})
  for i = 2, #net do
    local p = net.parent[i]
    local length = math.sqrt((net.x[i] - net.x[p]) ^ 2 + (net.y[i] - net.y[p]) ^ 2)
    lu.assertAlmostEquals(length, 0.022, 0.004)
    local off = math.min(distance_to(long, net.x[i], net.y[i]), distance_to(short, net.x[i], net.y[i]))
    lu.assertTrue(off < 0.003, off)
  end
  local laid = #net
  s:run()
  lu.assertTrue(#net > 3 * laid, #net)
  lu.assertEquals(net:measure().roots, 1)
  local unit = s.unit
  check_murray(net, 2.55, 0.0005 * unit)
  -- What grows by itself hangs from all of the guides.
  local from = {}
  for i = laid + 1, #net do
    if net.parent[i] <= laid then from[net.parent[i]] = true end
  end
  local count = 0
  for _ in pairs(from) do count = count + 1 end
  lu.assertTrue(count > 10, count)
end

function testGuidesGoOnFromRootsAndFromNetworks()
  local s = vessels {arteries = {roots = {{-0.5, 0}, {0.5, 0}}, guides = {{{0.45, 0}, {0.2, 0.2}}, {{-0.5, 0}, {-0.2, 0}}}}}
  lu.assertEquals(s.arteries:measure().roots, 2)
  lu.assertEquals(s.arteries:measure().tips, 2)
  local net = venule.network {}
  net:add(net:root(0, -0.5), 0, -0.3)
  s = vessels {arteries = {network = net, guides = {{{0, -0.3}, {0, 0}}}}}
  lu.assertEquals(s.arteries:measure().tips, 1)
  lu.assertEquals(s.arteries.parent[3], 2)
end

function testVeinsHaveGuidesToo()
  local s = vessels {arteries = {guides = {long}}, veins = {guides = {{{-0.48, -0.05}, {0.3, -0.06}}}}}
  s:run()
  lu.assertTrue(#s.veins > 60)
  lu.assertAlmostEquals(s.veins.y[1], -0.05, 0)
end

function testGuidesComeFromFiles()
  with_file(".svg", [[<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100"><g id="paths" fill="none" stroke="green">
    <path d="M10 50 C 30 40 50 60 70 50"/><line x1="40" y1="50" x2="45" y2="20"/></g><path d="M0 0h5"/></svg>]], function(path)
    local page = venule.domain.box {min = {0, 0}, max = {100, 100}}
    local given = {domain = page, rng = venule.rng(1), steps = 5, segment_length = 2, arteries = {guides = venule.paths(path, {id = "paths"})}}
    local s = venule.vessels(given)
    lu.assertEquals(s.arteries:measure().tips, 2)
    lu.assertEquals({s.arteries.x[1], s.arteries.y[1]}, {10, 50})
    given.arteries.guides = path -- with the stroke that is nowhere near
    fails(function() venule.vessels(given) end, "vessels.arteries.guides[3]: it begins at (0, 100)")
  end)
  with_file(".swc", "1 0 -0.5 0 0 1 -1\n2 0 -0.2 0.1 0 1 1\n3 0 0.3 0 0 1 2\n4 0 -0.1 0.4 0 1 2\n", function(path)
    local s = vessels {arteries = {guides = path}}
    lu.assertEquals(s.arteries:measure().tips, 2)
    lu.assertEquals(s.arteries:measure().bifurcations, 1)
    local same = vessels {arteries = {guides = venule.load(path)}}
    lu.assertEquals(#same.arteries, #s.arteries)
  end)
  with_file(".obj", "v -0.5 0 0\nv 0 0 0\nv 0.3 0 0.1\nl 1 2\nl 2 3\n", function(path)
    local ball = venule.domain.sphere {radius = 0.5}
    local s = venule.vessels {domain = ball, rng = venule.rng(1), steps = 2, arteries = {guides = path}}
    lu.assertEquals(s.arteries:measure().tips, 1)
    lu.assertEquals(s.arteries.dim, 3)
    fails(function() vessels {arteries = {guides = path}} end, "vessels.arteries.guides[1][3]: z = 0.1, but the network is flat")
  end)
end

function testGuidesKeepToASurface()
  local mesh = {vertices = {}, faces = {}}
  for j = 0, 20 do
    for i = 0, 20 do
      local x, y = i / 10 - 1, j / 10 - 1
      table.insert(mesh.vertices, {x, y, 0.4 * (x * x - y * y)})
      local a = #mesh.vertices
      if i < 20 and j < 20 then table.insert(mesh.faces, {a, a + 1, a + 22, a + 21}) end
    end
  end
  local saddle = venule.domain.mesh(mesh, {on = "surface"})
  local s = venule.vessels {
    domain = saddle, rng = venule.rng(1), steps = 30, growth = 0, perception_distance = 0.15,
    arteries = {guides = {{{-0.9, 0, 0.3}, {0, 0, 0.05}, {0.8, 0.3, 0.2}}}},
  }
  local laid = #s.arteries
  lu.assertTrue(laid > 25, laid)
  s:run()
  lu.assertTrue(#s.arteries > 2 * laid, #s.arteries)
  for i = 1, #s.arteries do
    lu.assertTrue(saddle:contains(s.arteries.x[i], s.arteries.y[i], s.arteries.z[i]))
  end
end

function testWrongGuidesAreOneLine()
  local function refused(guides, ...)
    local messages = {...}
    fails(function() vessels {arteries = {guides = guides}} end, table.unpack(messages))
  end
  refused({long, {{-0.2, 0.1}, {0, 0.3}, {0, 0.6}}}, "vessels.arteries.guides[2]: point 3 at (0, 0.6) is outside the domain, by 0.1: move it inside")
  refused({long, {{0, 0.4}, {0, 0.1}}}, "guides[2]: it begins at (0, 0.4), 0.3", "and may be 0.065 at most", "in reverse")
  refused({long, short, {{-0.2, 0.1}, {-0.2, -0.3}}}, "guides[3]: it would be the third vessel from the fork at (")
  refused({long, long}, "guides[2]: from (-0.5, 0) on it lies on another one")
  refused({{{-0.5, 0}, {0.3, 0 / 0}}}, "vessels.arteries.guides[1][2]: (0.3,", "is not finite")
  refused({{{-0.5, 0}, {"0", 0}}}, "vessels.arteries.guides[1][2]: number expected")
  refused({{-0.5, 0}, {0, 0}}, "vessels.arteries.guides[1][1]: a point {x, y} expected, got number")
  refused({{}}, "vessels.arteries.guides[1]: a path is a list of points", "got an empty one")
  refused({}, "vessels.arteries: give roots")
  refused(7, "vessels.arteries.guides: paths {{{x, y}, …}, …}, a network or the name of a file expected, got number")
  refused("nowhere.swc", "nowhere.swc: cannot be")
  refused("guides.stl", "lines are read from .svg, .obj")
  refused(disk, "network")
  fails(function() vessels {arteries = {roots = {{-0.5, 0}}, guide = {}}} end, 'did you mean "guides"?')
end

function testTheSameGuidesGiveTheSameBytes()
  local function sum()
    local s = vessels {arteries = {guides = {long, short}}}
    s:run()
    local total = 0
    for i = 1, #s.arteries do total = total + s.arteries.x[i] * i end
    return total
  end
  lu.assertEquals(sum(), sum())
end
