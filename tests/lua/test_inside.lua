-- The inside of a mesh and the shell of a domain, as a script sees them.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

-- Boxes, each by its lowest and highest coordinate; faces are quadrangles.
local function boxes(...)
  local mesh = {vertices = {}, faces = {}}
  for _, b in ipairs {...} do
    local n = #mesh.vertices
    for i = 0, 7 do
      table.insert(mesh.vertices, {b[1 + (i & 1)], b[1 + (i >> 1 & 1)], b[1 + (i >> 2 & 1)]})
    end
    for _, f in ipairs {{1, 5, 7, 3}, {2, 4, 8, 6}, {1, 2, 6, 5}, {3, 7, 8, 4}, {1, 3, 4, 2}, {5, 6, 8, 7}} do
      table.insert(mesh.faces, {n + f[1], n + f[2], n + f[3], n + f[4]})
    end
  end
  return mesh
end

function testAHollowBox()
  local d = venule.domain.mesh(boxes({0, 10}, {3, 7}), {on = "inside"})
  lu.assertAlmostEquals(d:measure(), 936, 1e-9)
  lu.assertEquals(d.dim, 3)
  lu.assertEquals(d:bounds().max, {10, 10, 10})
  lu.assertTrue(d:contains(1, 5, 5))
  lu.assertFalse(d:contains(5, 5, 5))
  lu.assertEquals(d:distance(1, 5, 5), 1)
  lu.assertEquals(d:distance(5, 5, 5.5), -1.5)
  lu.assertEquals({d:closest(5, 5, 11)}, {5, 5, 10})
  for _, p in ipairs(d:sample(100, {rng = venule.rng(1)})) do lu.assertTrue(d:contains(p[1], p[2], p[3])) end
end

function testInsidesCombine()
  local cube = venule.domain.mesh(boxes({0, 2}), {on = "inside"})
  local rest = cube - venule.domain.sphere {center = {1, 1, 1}, radius = 0.5}
  lu.assertFalse(rest:contains(1, 1, 1))
  lu.assertAlmostEquals(rest:measure(), 8 - math.pi / 6, 0.01)
end

function testVesselsStayInALiver()
  local liver = venule.domain.mesh("scripts/data/liver.obj", {on = "inside"})
  lu.assertAlmostEquals(liver:measure(), 1741605.8, 0.1)
  local shell = venule.domain.shell {domain = liver, thickness = 8}
  for _, domain in ipairs {liver, shell} do
    local root = domain:sample(1, {rng = venule.rng(3)})[1]
    local tree = venule.venation {
      domain = domain, rng = venule.rng(2), roots = {root}, darts = 5e-4, birth_distance = 12, kill_distance = 3,
      segment_length = 3, attraction_distance = 40,
    }
    local net = tree:run().network
    lu.assertTrue(#net > 500)
    for i = 1, #net do lu.assertTrue(domain:distance(net.x[i], net.y[i], net.z[i]) > -1e-6) end
  end
end

function testShells()
  local ring = venule.domain.shell {domain = venule.domain.disk {radius = 2}, thickness = 0.5}
  lu.assertEquals(ring.dim, 2)
  lu.assertAlmostEquals(ring:measure(), math.pi * 1.75, 1e-4)
  lu.assertFalse(ring:contains(0, 0))
  lu.assertAlmostEquals(ring:distance(1.75, 0), 0.25, 1e-12)
  local c = venule.canvas {width = 100, height = 100, view = ring:bounds()}
  c:fill(ring, {color = "#000"})
end

function testWhatAScriptGetsWrongIsNamed()
  local mesh, inside = venule.domain.mesh, {on = "inside"}
  local open = boxes({0, 1})
  table.remove(open.faces)
  fails(function() mesh(open, inside) end, "mesh: the mesh is not closed: edges with a triangle on one side only: 4, around 1 hole, the largest of 4 edges, the first at vertex")
  local whole, repairs = mesh(open, {on = "inside", repair = true})
  lu.assertEquals(whole:measure(), 1)
  lu.assertEquals(repairs, {merged = 0, removed = 0, turned = 0, sewn = 0, holes = 1, largest_hole = 4})
  fails(function() mesh(boxes({0, 2}, {1, 3}), inside) end, "mesh: the mesh crosses or touches itself: the edge from vertex")
  lu.assertFalse(mesh(boxes({0, 2}, {1, 3}), {on = "inside", check = false}):contains(1.5, 1.5, 1.5))
  fails(function() mesh(open, {on = "inside", chek = false}) end, 'did you mean "check"?')
  fails(function() mesh(open, {on = "inside", check = 1}) end, "mesh.check: true or false expected, got number")
  fails(function() return mesh(boxes({0, 1}), {on = "surface"}) - mesh(boxes({0, 1}), inside) end, "a surface cannot be combined")
  local shell, disk = venule.domain.shell, venule.domain.disk {}
  fails(function() shell {domain = disk} end, "shell: `thickness` is missing")
  fails(function() shell {thickness = 1} end, "shell: `domain` is missing")
  fails(function() shell {domain = disk, thickness = -1} end, "shell.thickness = -1 must be above 0")
  fails(function() shell {domain = 7, thickness = 1} end, "shell.domain")
  fails(function() shell {domain = mesh(open), thickness = 1} end, "shell.domain is a surface")
  fails(function() shell {domain = disk, thicknes = 1} end, 'did you mean "thickness"?')
end
