-- A poplar leaf with open venation: Runions et al. 2005, sections 3.1 to 3.5, on a blade that grows at its margin.
-- Lengths are vein segments: the grown blade is 1600 of them long, as in the paper's exploration of parameters (Table 1).
local venule = require "venule"

local p = venule.param {
  {"outline", "outlines/poplar.svg", file = true, help = "SVG file with the shape of the blade"},
  {"birth_distance", 14, min = 1, max = 200, help = "a new source keeps this far from veins and other sources"},
  {"kill_distance", 3, min = 1, max = 200, help = "a vein this close consumes its source"},
  {"darts", 3000e-6, min = 1e-6, max = 0.1, unit = "darts/length²", help = "sources that are tried per area"},
  {"from", 270, min = 1, max = 1600, help = "length of the blade at first"},
  {"growth", 16, min = 0.5, max = 100, help = "length that a step adds to it"},
  {"width", 900, min = 50, max = 8000, unit = "pixels", help = "of the picture"},
}

local blade = venule.growth.marginal {
  domain = venule.domain.svg(p.outline, {pick = "largest"}), from = p.from, to = 1600, step = p.growth,
}

local leaf = venule.venation {
  domain = blade,
  rng = venule.rng(p.seed),
  darts = p.darts,
  birth_distance = p.birth_distance,
  kill_distance = p.kill_distance,
  murray = {exponent = 2, tip_radius = 0.5},
}
leaf:run()

-- At exponent 2 the midrib is about √tips as wide as a tip (READINGS R7): choose the tips by it, 1 % of the blade's length.
local veins = leaf.network
local midrib = veins:measure().max_radius
veins:murray {exponent = 2, tip_radius = 0.5 * 8 / midrib}
veins:orders "hickey"

venule.result {
  network = veins,
  width = p.width,
  view = blade:bounds(),
  background = "#fdfcf7",
  picture = function(page)
    page:fill(blade, {color = "#dbe8c4", stroke = "#8aa36a", line_width = 3})
    page:stroke(veins, {color = "#3d5c2b", min_width = 0.45})
  end,
}
