-- Kerautret et al. 2023, Figure 7 b and c: a tree in a cube, and how thick its segments are at each bifurcation level: how many
-- forks lie between them and the root. Thick vessels have few forks above them; a thin one may hang anywhere.
local venule = require "venule"

local p = venule.param {
  {"terminals", 1000, min = 2, max = 1000000, help = "ends of the tree"},
  {"draw", "tree", choices = {"tree", "levels"}, help = "b, or the plot c"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"size", 1400, min = 100, max = 8000, unit = "pixels", help = "width of the picture"},
}

local tree = venule.cco {dim = 3, square = true, terminals = p.terminals, viscosity = p.viscosity, seed = p.seed}
tree:run {progress = true}

local half = tree.domain:bounds().max[1]
local edges = venule.network {dim = 3}
for _, a in ipairs {{-1, -1, -1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}} do -- four corners that touch every edge
  for k = 1, 3 do
    local b = {a[1], a[2], a[3]}
    b[k] = -a[k]
    edges:add(edges:root(half * a[1], half * a[2], half * a[3]), half * b[1], half * b[2], half * b[3])
  end
end

local function levels()
  local x, mean, deviation = {}, {}, {}
  for i, level in ipairs(tree.network:levels()) do
    x[i], mean[i], deviation[i] = level.level, level.diameter.mean, level.diameter.deviation
  end
  return venule.plot {
    width = p.size, height = p.size * 0.6, text_size = p.size / 50,
    x = {label = "bifurcation level"}, y = {label = "diameter, mm", min = 0},
    series = {{x = x, y = mean, deviation = deviation, band = true, marks = true, color = "#b3201c", label = "mean and deviation"}},
  }
end

venule.result {
  network = tree.network, width = p.size, view = tree.domain:bounds(), background = "#ffffff",
  camera = p.draw == "tree" and {from = {4 * half, 3 * half, 8 * half}, to = {0, 0, 0}, fov = 25, zoom = 1.25, fog = 0.5} or nil,
  picture = p.draw == "levels" and levels() or function(page)
    page:stroke(edges, {color = "#b9b2ae", width = half / 150})
    page:stroke(tree.network, {color = "#b81f18", min_width = 0.5})
  end,
}
