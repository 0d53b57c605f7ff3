-- Venation on the surface of a mesh, as a script sees it.
local venule = require "venule"
local lu = require "luaunit"

local function fails(f, message)
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

-- A sheet of quadrangles over [-1, 1]², bent to z = height(x, y).
local function sheet(n, height)
  local mesh = {vertices = {}, faces = {}}
  for j = 0, n do
    for i = 0, n do
      local x, y = 2 * i / n - 1, 2 * j / n - 1
      table.insert(mesh.vertices, {x, y, height(x, y)})
      local a = #mesh.vertices
      if i < n and j < n then table.insert(mesh.faces, {a, a + 1, a + n + 2, a + n + 1}) end
    end
  end
  return mesh
end

local function saddle(x, y) return 0.6 * (x * x - y * y) end

local function write_obj(mesh, path)
  local file = assert(io.open(path, "w"))
  for _, v in ipairs(mesh.vertices) do file:write(("v %.17g %.17g %.17g\n"):format(v[1], v[2], v[3])) end
  for _, f in ipairs(mesh.faces) do file:write("f ", table.concat(f, " "), "\n") end
  file:close()
end

local function grow(domain, neighborhood)
  local leaf = venule.venation {
    domain = domain, rng = venule.rng(2), roots = {{0, 0, 0}}, darts = 20, birth_distance = 0.1, kill_distance = 0.02,
    segment_length = 0.02, attraction_distance = 0.5, neighborhood = neighborhood,
  }
  return leaf:run()
end

function testBothVenationsKeepToASaddle()
  local domain = venule.domain.mesh(sheet(30, saddle), {on = "surface"})
  for _, neighborhood in ipairs {"nearest", "relative"} do
    local leaf = grow(domain, neighborhood)
    local net = leaf.network
    lu.assertEquals(#leaf.attractors, 0)
    lu.assertTrue(#net > 500)
    lu.assertEquals(net.dim, 3)
    for i = 1, #net do
      lu.assertTrue(domain:contains(net.x[i], net.y[i], net.z[i]))
      lu.assertAlmostEquals(net.z[i], saddle(net.x[i], net.y[i]), 0.01)
    end
    lu.assertEquals(net:measure().joins > 20, neighborhood == "relative")
  end
end

function testClosedVenationFillsABall()
  local leaf = venule.venation {
    domain = venule.domain.sphere {radius = 1}, rng = venule.rng(1), roots = {{0, 0, -1}}, darts = 20, birth_distance = 0.25,
    kill_distance = 0.05, segment_length = 0.05, attraction_distance = 0.8, neighborhood = "relative",
  }
  leaf:run()
  lu.assertEquals(#leaf.attractors, 0)
  lu.assertTrue(leaf.network:measure().joins > 20)
end

function testAFileIsTheSameSurfaceAsItsTable()
  local mesh, path = sheet(4, saddle), os.tmpname() .. ".obj"
  write_obj(mesh, path)
  local a, b = venule.domain.mesh(mesh), venule.domain.mesh(path)
  os.remove(path)
  lu.assertEquals(a:measure(), b:measure())
  lu.assertEquals(a:sample(5, {rng = venule.rng(1)}), b:sample(5, {rng = venule.rng(1)}))
  lu.assertEquals(a:bounds().max, {1, 1, 0.6})
end

function testWhatAScriptGetsWrongIsNamed()
  local corners = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}
  local mesh = venule.domain.mesh
  fails(function() mesh({vertices = corners, faces = {{1, 2, 3}}}, {on = "outside"}) end, 'mesh.on = "outside" must be one of surface|inside')
  fails(function() mesh {vertices = corners, faces = {{1, 2, 4}}} end, "mesh: face 1 has a corner at vertex 4, but the vertices are 1 to 3")
  fails(function() mesh {vertices = corners, faces = {{1, 2, 0}}} end, "corner at vertex 0")
  fails(function() mesh {vertices = corners, faces = {{1, 2, 2 ^ 53 | 0}}} end, "mesh: face 1 has a corner")
  fails(function() mesh {vertices = corners, faces = {{1, 2, 2.5}}} end, "mesh.faces")
  fails(function() mesh {vertices = corners, faces = {{1, 2}}} end, "mesh: face 1 has 2 corners")
  fails(function() mesh {vertices = {{0, 0}}, faces = {{1, 2, 3}}} end, "mesh.vertices[1]: a point {x, y, z} expected")
  fails(function() mesh {vertices = {}, faces = {}} end, "mesh: the mesh is empty")
  fails(function() mesh {faces = {}} end, "mesh.vertices: a list expected, got nil")
  fails(function() mesh "no-such.obj" end, "no-such.obj: cannot be read")
  fails(function() mesh(7) end, "7: a mesh is read from .obj, .off, .ply, .stl, .glb or .gltf")
  fails(function() return mesh {vertices = corners, faces = {{1, 2, 3}}} - venule.domain.sphere {} end, "a surface cannot be combined")
end
