-- A poplar leaf with reticulate venation: Figure 18 of Runions et al. 2005, and the poplar of their Table 1.
--   venule run scripts/poplar.lua -o poplar.svg -o poplar.png
--   venule run scripts/poplar.lua --set neighborhood=urquhart -o urquhart.png
--   venule run scripts/poplar.lua --set outline=outlines/leaf-ivy.svg --set to=1500 -o ivy.png
-- Lengths are vein segments: the blade grows from 115 of them to 3500, and everything in it grows alike.
local venule = require "venule"

local p = venule.param {
  {"outline", "outlines/poplar.svg", file = true, help = "SVG file with the shape of the blade"},
  {"neighborhood", "relative", choices = {"relative", "urquhart", "nearest"}, help = "which veins a source draws; nearest: no loops"},
  {"birth_distance", 2, min = 0.5, max = 100, help = "a new source keeps this far from veins and other sources"},
  {"kill_distance", 1, min = 0.5, max = 100, help = "a vein this close has reached its source"},
  {"darts", 200e-6, min = 1e-6, max = 0.1, unit = "darts/length²", help = "sources that are tried per area and step"},
  {"from", 115, min = 10, max = 10000, help = "length of the blade at first"},
  {"to", 3500, min = 10, max = 10000, help = "and when it is grown"},
  {"growth", 9, min = 0.1, max = 1000, help = "length that a step adds to it"},
  {"width", 900, min = 50, max = 8000, unit = "pixels", help = "of the picture"},
  {"hide_below", 0.04, min = 0, max = 10, unit = "pixels", help = "veins thinner than this on the picture are left out of it"},
}

local blade = venule.growth.isogonic {
  domain = venule.domain.svg(p.outline, {pick = "largest"}), from = p.from, to = p.to, step = p.growth,
}

local leaf = venule.venation {
  domain = blade,
  rng = venule.rng(p.seed),
  darts = p.darts,
  birth_distance = p.birth_distance,
  kill_distance = p.kill_distance,
  neighborhood = p.neighborhood,
  murray = {exponent = 2},
}
leaf:run()

-- At exponent 2 the midrib is about √tips as wide as a tip (READINGS R7): choose the tips by it, 1 % of the blade's length.
local veins = leaf.network
local midrib = 0.01 * p.from
veins:murray {exponent = 2, tip_radius = midrib / 2 / veins:measure().max_radius}
veins:orders "hickey"

venule.result {
  network = veins,
  width = p.width,
  view = blade:bounds(),
  background = "#fdfcf7",
  picture = function(page)
    page:fill(blade, {color = "#dbe8c4", stroke = "#8aa36a", line_width = 0.25})
    page:stroke(veins, {color = "#3d5c2b", min_width = 0.3, hide_below = p.hide_below})
  end,
}
