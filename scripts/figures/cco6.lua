-- Kerautret et al. 2023, Figure 6, in another organ: the thick shell of a liver, which is hollow. Vessels go round the cavity and
-- never through it. `--set terminals=20000` is the dense one, `--set cut=true` leaves the back alone, so that the hollow is seen.
local venule = require "venule"

local p = venule.param {
  {"terminals", 3000, min = 1, max = 1000000, help = "ends of the tree; 20000 in b"},
  {"thickness", 14.0, min = 2, max = 60, unit = "mm", help = "of the shell"},
  {"cut", false, help = "only what is behind the middle"},
  {"inflow", 500.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "into the root"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}

local liver = venule.domain.mesh("../data/liver.obj", {on = "inside"})
local shell = venule.domain.shell {domain = liver, thickness = p.thickness}
local bounds = liver:bounds()
local low, high = bounds.min, bounds.max
local middle = {(low[1] + high[1]) / 2, (low[2] + high[2]) / 2, (low[3] + high[3]) / 2}
if p.cut then shell = shell * venule.domain.box {min = {low[1] - 1, low[2] - 1, low[3] - 1}, max = {high[1] + 1, high[2] + 1, middle[3]}} end

local tree = venule.cco {
  domain = shell, terminals = p.terminals, inflow = p.inflow * 1000 / 60, viscosity = p.viscosity, seed = p.seed,
  spacing = 0.25, -- first terminals that lie far apart are soon beyond the shell's bend: straight lines leave it
  root = {shell:closest(middle[1], middle[2], p.cut and low[3] or middle[3])},
}
tree:run {progress = true}

venule.result {
  network = tree.network, view = bounds, width = p.size, height = p.size * 0.8 // 1, background = "#ffffff",
  camera = {from = {middle[1] + 150, middle[2] + 120, middle[3] + 480}, to = middle, fov = 30, zoom = 1.25, fog = p.cut and 0.4 or 0.7},
  picture = function(page) page:stroke(tree.network, {color = "#a81c16", min_width = 0.5}) end,
}
