-- Vessels of the retina around the fovea, 3 mm × 3 mm:  venule run scripts/retina.lua -o retina.png -o retina.json
-- Eight arteries and eight veins come in from the sides; in the middle there are none. A first stage lays out the vessels that
-- one sees, a second one the finer bed between them.
local venule = require "venule"

local p = venule.param {
  {"avascular_radius", 0.44, min = 0, max = 1.3, unit = "mm", help = "of the middle, give or take 0.04 by chance"},
  {"first_steps", 100, min = 1, max = 1000, help = "of the first stage"},
  {"second_steps", 150, min = 1, max = 1000, help = "of the second stage"},
  {"vein_sight", 2.0, min = 0.5, max = 10, help = "δ of veins by that of arteries: with the same they could not follow"},
  {"darts", 2000, min = 1, max = 10000000, help = "thrown in each step"},
  {"avoid", false, help = "arteries and veins keep clear of one another"},
  {"size", 1400, min = 50, max = 16000, unit = "pixels", help = "of the picture's sides"},
}

local rng = venule.rng(p.seed)
local half, depth = 1.5, 0.0131 * 3
local tissue = venule.domain.box {min = {-half, -half, -depth / 2}, max = {half, half, depth / 2}}
local radius = p.avascular_radius + rng:normal(0, 0.04)
if radius > 0 then tissue = tissue - venule.domain.sphere {radius = radius} end

-- Around the square, arteries and veins in turn.
local roots = {arteries = {}, veins = {}}
for i = 0, 15 do
  local side, along = i // 4, ((i % 4) + 0.5) / 2 - 1 + rng:uniform(-0.08, 0.08)
  local x, y = half * along, -half
  for _ = 1, side do x, y = -y, x end
  local trees = i % 2 == 0 and roots.arteries or roots.veins
  trees[#trees + 1] = {x, y, 0}
end

local s = venule.vessels {
  domain = tissue, rng = rng, growth = 0.02, darts = p.darts, unit = "mm", avoid = p.avoid,
  bifurcation_threshold = 15, segment_length = 0.1, tip_radius = 0.0025,
  arteries = {roots = roots.arteries},
  veins = {roots = roots.veins},
  stages = {
    {
      steps = p.first_steps, drain_clearance = 0.18, drain_spacing = 0.135, satisfaction = 0.135, perception_distance = 0.2925,
      perception_angle = 50, bias = 0.3, murray_exponent = 2.55, veins = {perception_distance = 0.2925 * p.vein_sight},
    },
    {
      steps = p.second_steps, drain_clearance = 0.09, drain_spacing = 0.0675, satisfaction = 0.0675, perception_distance = 0.14625,
      perception_angle = 90, bias = 0, murray_exponent = 2.9, veins = {perception_distance = 0.14625 * p.vein_sight},
    },
  },
}
s:run {progress = true}

venule.result {
  networks = s.networks, view = tissue:bounds(), width = p.size, background = "#fbf4ee",
  camera = {from = {0, 0, 60}, to = {0, 0, 0}, up = {0, 1, 0}, fov = 2 * math.deg(math.atan(half / 60)), fog = 0},
  picture = function(page)
    page:stroke(s.veins, {color = "#3f6aa8"})
    page:stroke(s.arteries, {color = "#c23b2e"})
  end,
}
