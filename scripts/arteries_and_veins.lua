-- Arteries and veins of one organ:  venule run scripts/arteries_and_veins.lua -o organ.png -o organ.json
-- Two trees take turns, a terminal each, and never meet: the red trunk comes from above, the blue one, wider as less pressure
-- drives it, leaves below, and everywhere a red twig ends beside a blue one. (In a plane this cannot be: each tree would fence the
-- other in, which is why only the ball is here.)
local venule = require "venule"

local p = venule.param {
  {"terminals", 1000, min = 1, max = 1000000, help = "ends of each tree"},
  {"inflow", 500.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "through both"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"turn", 30.0, min = -360, max = 360, unit = "degrees", help = "from where it is seen"},
  {"size", 1400, min = 50, max = 16000, unit = "pixels", help = "of the picture's sides"},
}

local mmHg = 133.322
local organ = venule.cco {
  dim = 3, terminals = p.terminals, inflow = p.inflow * 1000 / 60, viscosity = p.viscosity, seed = p.seed,
  trees = {
    {name = "arteries"}, -- enter at the top
    {name = "veins", venous = true, pressure_in = 40 * mmHg, pressure_out = 10 * mmHg}, -- leave at the bottom
  },
}
organ:run {progress = true}

local bounds, angle = organ.domain:bounds(), math.rad(p.turn)
local far = 5 * bounds.max[2]

venule.result {
  networks = organ.networks, view = bounds, width = p.size, background = "#ffffff",
  camera = {from = {far * math.sin(angle), far / 3, far * math.cos(angle)}, to = {0, 0, 0}, fov = 25, fog = 0.5},
  picture = function(page)
    page:stroke(organ.arteries, {color = "#c23b2e", min_width = 0.5})
    page:stroke(organ.veins, {color = "#3f6aa8", min_width = 0.5})
  end,
}
