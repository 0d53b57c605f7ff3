-- An arterial tree in a disk, Figure 4 of Kerautret et al. 2023:  venule run scripts/arterial_disk.lua -o tree.xml -o disk.png
-- Blood enters at the top. Each terminal is connected where the whole tree's volume stays least, so that thin vessels leave
-- thick ones nearly square, and equal ones part at wide angles. `--set terminals=40 --set discs=true` shows what each terminal
-- feeds (Figure 3).
local venule = require "venule"

local p = venule.param {
  {"terminals", 4000, min = 1, max = 10000000, help = "ends of the tree, each of which feeds an equal share of the disk"},
  {"perfusion", 20000.0, min = 1e-3, max = 1e9, unit = "mm²", help = "area that is fed"},
  {"square", false, help = "a square in place of the disk"},
  {"inflow", 500.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "into the root, once the tree is whole"},
  {"exponent", 3.0, min = 1, max = 100, help = "γ: r^γ adds up where vessels part"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"border_distance", 0.0, min = 0, max = 1000, unit = "mm", help = "that vessels keep from the border"},
  {"root", "", help = "x,y in mm, where blood enters; left out: the top"},
  {"discs", false, help = "draw the disc that each terminal feeds"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "of the picture's sides"},
}

local x, y = p.root:match "^([^,]+),([^,]+)$"
local tree = venule.cco {
  root = x and {tonumber(x), tonumber(y)} or nil, terminals = p.terminals, perfusion = p.perfusion, square = p.square,
  inflow = p.inflow * 1000 / 60, exponent = p.exponent, viscosity = p.viscosity, border_distance = p.border_distance,
  seed = p.seed,
}
tree:run {progress = true}
local arteries = tree.network

-- What the ends feed are discs of area A each, of radius √(A/π); they cover the disk about once.
local function discs(page)
  local centers = {}
  for i, node in ipairs(arteries:flow {solve = false}.terminals.node) do centers[i] = {arteries.x[node], arteries.y[node]} end
  page:dots(centers, {color = "#e58a7a", opacity = 0.4, radius = math.sqrt(p.perfusion / p.terminals / math.pi)})
end

venule.result {
  network = arteries, view = tree.domain:bounds(), width = p.size, margin = p.size / (p.discs and 10 or 40), background = "#ffffff",
  picture = function(page)
    page:fill(tree.domain, {color = "#fdf3ef", stroke = "#b08a80"})
    if p.discs then discs(page) end
    page:stroke(arteries, {color = "#b3201c", min_width = 0.4})
  end,
}
