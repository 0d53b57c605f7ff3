-- Closed venation on a blade that is not flat:  venule run scripts/curved.lua --set shape=dome -o dome.png
-- The blade is a height field z = f(x, y) over a leaf's outline. Where it is a dome its Gaussian curvature is positive, on a
-- saddle and along a ruffled margin negative. The petiole is at (0, 0), the blade is 1 long.
local venule = require "venule"

local shapes = {
  dome = function(x, y) return -0.9 * (x * x + (y - 0.5) ^ 2) end,
  saddle = function(x, y) return 0.9 * (x * x - (y - 0.5) ^ 2) end,
  ruffled = function(x, y, side)
    return 0.045 * side * side * math.sin(math.pi * y) * math.sin(26 * y + (x > 0 and 2 or 0)) - 0.25 * y * y
  end,
}

local p = venule.param {
  {"shape", "saddle", choices = {"dome", "saddle", "ruffled"}, help = "of the blade"},
  {"width", 0.62, min = 0.1, max = 1.5, help = "of the blade, where it is widest"},
  {"areole", 0.016, min = 0.005, max = 0.2, help = "distance of the finest veins"},
  {"turn", 24, min = -180, max = 180, unit = "degrees", help = "about the midrib"},
  {"tilt", -30, min = -90, max = 90, unit = "degrees", help = "away from the viewer"},
  {"size", 1100, min = 50, max = 8000, unit = "pixels", help = "of the picture"},
}

-- The mesh: rows across the blade, from the petiole to the tip. `side` runs from -1 to 1 across it.
local ROWS, COLUMNS = 160, 72

local function vertex(row, column)
  local y, side = row / ROWS, 2 * column / COLUMNS - 1
  local x = side * p.width / 2 * (0.004 + math.sin(math.pi * y ^ 0.75) ^ 0.9)
  return {x, y, shapes[p.shape](x, y, side)}
end

local mesh = {vertices = {}, faces = {}}
for row = 0, ROWS do
  for column = 0, COLUMNS do
    table.insert(mesh.vertices, vertex(row, column))
    local a = #mesh.vertices
    if row < ROWS and column < COLUMNS then table.insert(mesh.faces, {a, a + 1, a + COLUMNS + 2, a + COLUMNS + 1}) end
  end
end
local blade = venule.domain.mesh(mesh, {on = "surface"})

-- A midrib to begin with; then veins, coarse ones first.
local MURRAY = {exponent = 2.8, tip_radius = 0.0005}
local veins = venule.network {dim = 3, murray = MURRAY}
local tip = veins:root(table.unpack(vertex(0, COLUMNS / 2)))
for row = 1, ROWS - 6 do tip = veins:add(tip, table.unpack(vertex(row, COLUMNS / 2))) end

local rng = venule.rng(p.seed)
for _, distance in ipairs {8 * p.areole, 2.8 * p.areole, p.areole} do
  venule.venation {
    domain = blade, network = veins, rng = rng, neighborhood = "relative", birth_distance = distance,
    darts = 4 / distance ^ 2, segment_length = 0.004, kill_distance = 0.004, attraction_distance = 3 * distance,
  }:run()
end

-- The projection: turn about the y axis, tilt about the x axis; z is the depth then, which is dropped.
local function rotate(a, b, degrees)
  local cosine, sine = math.cos(math.rad(degrees)), math.sin(math.rad(degrees))
  return cosine * a - sine * b, sine * a + cosine * b
end

local function project(x, y, z)
  z, x = rotate(z, x, p.turn)
  y, z = rotate(y, z, p.tilt)
  return x, y, z
end

local view = {min = {math.huge, math.huge}, max = {-math.huge, -math.huge}}
local corners = {}
for i, v in ipairs(mesh.vertices) do
  local x, y, depth = project(table.unpack(v))
  corners[i] = {x, y, depth}
  view.min = {math.min(view.min[1], x), math.min(view.min[2], y)}
  view.max = {math.max(view.max[1], x), math.max(view.max[2], y)}
end

-- The colour of a face by its normal, lit from the upper left.
local function color_of(a, b, c, d)
  local ux, uy, uz, vx, vy, vz = c[1] - a[1], c[2] - a[2], c[3] - a[3], d[1] - b[1], d[2] - b[2], d[3] - b[3]
  local nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
  local light = math.abs(-0.48 * nx + 0.4 * ny + 0.78 * nz) / math.sqrt(nx * nx + ny * ny + nz * nz)
  light = 0.62 + 0.38 * light
  return ("#%02x%02x%02x"):format(math.floor(228 * light), math.floor(240 * light), math.floor(200 * light))
end

local function fill_triangle(page, a, b, c, color)
  local area = (b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1])
  if math.abs(area) < 1e-9 then return end -- seen edge on
  page:fill(venule.domain.polygon {{a[1], a[2]}, {b[1], b[2]}, {c[1], c[2]}}, {color = color, stroke = color})
end

-- Far faces first.
local function fill_blade(page)
  table.sort(mesh.faces, function(f, g)
    local df, dg = corners[f[1]][3] + corners[f[3]][3], corners[g[1]][3] + corners[g[3]][3]
    return df < dg or df == dg and f[1] < g[1]
  end)
  for _, f in ipairs(mesh.faces) do
    local a, b, c, d = corners[f[1]], corners[f[2]], corners[f[3]], corners[f[4]]
    local color = color_of(a, b, c, d)
    fill_triangle(page, a, b, c, color)
    fill_triangle(page, a, c, d, color)
  end
end

local function flat_copy(net)
  local flat = venule.network {murray = MURRAY}
  for i = 1, #net do
    local x, y = project(net.x[i], net.y[i], net.z[i])
    if net.parent[i] > 0 then flat:add(net.parent[i], x, y) else flat:root(x, y) end
  end
  for _, join in ipairs(net:joins()) do flat:join(join.a, join.b) end
  return flat
end

venule.result {
  network = veins, height = p.size, view = view, margin = 30, background = "#fdfcf7",
  picture = function(page)
    fill_blade(page)
    page:stroke(flat_copy(veins), {color = "#3d5c2b", min_width = 0.5})
  end,
}
