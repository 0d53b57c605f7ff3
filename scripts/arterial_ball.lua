-- An arterial tree in a ball, seen through a camera, Figure 5 of Kerautret et al. 2023:
--   venule run scripts/arterial_ball.lua -o ball.png         `--set terminals=4000` is Figure 5 b, `--set turn=90` walks round it
-- The trunk enters at the top; what comes towards you is bright, what is far fades.
local venule = require "venule"

local p = venule.param {
  {"terminals", 1000, min = 1, max = 10000000, help = "ends of the tree"},
  {"perfusion", 20000.0, min = 1e-3, max = 1e9, unit = "mm³", help = "volume that is fed"},
  {"square", false, help = "a cube in place of the ball"},
  {"inflow", 500.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "into the root, once the tree is whole"},
  {"exponent", 3.0, min = 1, max = 100, help = "γ: r^γ adds up where vessels part"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"border_distance", 0.0, min = 0, max = 1000, unit = "mm", help = "that vessels keep from the border"},
  {"turn", 30.0, min = -360, max = 360, unit = "degrees", help = "from where it is seen"},
  {"fog", 0.5, min = 0, max = 1, help = "how much what is far fades"},
  {"size", 1400, min = 50, max = 16000, unit = "pixels", help = "of the picture's sides"},
}

local tree = venule.cco {
  dim = 3, terminals = p.terminals, perfusion = p.perfusion, square = p.square, inflow = p.inflow * 1000 / 60,
  exponent = p.exponent, viscosity = p.viscosity, border_distance = p.border_distance, seed = p.seed,
}
tree:run {progress = true}

local bounds, angle = tree.domain:bounds(), math.rad(p.turn)
local far = 5 * bounds.max[2]

venule.result {
  network = tree.network, view = bounds, width = p.size, background = "#ffffff",
  camera = {from = {far * math.sin(angle), far / 3, far * math.cos(angle)}, to = {0, 0, 0}, fov = 25, fog = p.fog},
  picture = function(page) page:stroke(tree.network, {color = "#b81f18", min_width = 0.5}) end,
}
