-- Arteries and veins in a disk, Figure 5a-b of Rauch & Harders 2021:  venule run scripts/vessels_disk.lua -o vessels.svg
-- They grow together: what arteries have reached, veins drain. `--set murray_exponent=3.4` widens the angles (Figure 5c),
-- `--set bias=0.9` straightens (5d), `--set bifurcation_threshold=40` gives laterals in place of forks (5e).
-- `-o vessels.json` writes both networks.
local venule = require "venule"

local p = venule.param {
  {"steps", 100, min = 1, max = 5000, help = "how many; the disk grows in each"},
  {"growth", 0.02, min = 0, max = 1, help = "Δσ: by how much of its first size"},
  {"darts", 1000, min = 1, max = 10000000, help = "thrown in each step"},
  {"murray_exponent", 2.55, min = 2.01, max = 4, help = "κ: large ones widen the angles"},
  {"bias", 0.5, min = 0, max = 1, help = "ω: how straight vessels grow"},
  {"bifurcation_threshold", 15.0, min = 0.001, max = 180, unit = "degrees", help = "φ: above it a tip forks"},
  {"perception_angle", 90.0, min = 1, max = 360, unit = "degrees", help = "γ"},
  {"perception_distance", 0.065, min = 1e-4, max = 1, unit = "diameters", help = "δ of arteries"},
  {"drain_spacing", 0.03, min = 1e-4, max = 1, unit = "diameters", help = "ε_s, of drains from one another"},
  {"drain_clearance", 0.04, min = 1e-4, max = 1, unit = "diameters", help = "ε_n, of drains from arteries"},
  {"satisfaction", 0.03, min = 1e-4, max = 1, unit = "diameters", help = "ε_k: a vessel this close satisfies a drain"},
  {"segment_length", 0.022, min = 1e-4, max = 1, unit = "diameters", help = "d"},
  {"vein_perception_distance", 0.1, min = 1e-4, max = 1, unit = "diameters", help = "δ of veins, which follow the arteries"},
  {"avoid", false, help = "arteries and veins keep clear of one another"},
  {"size", 1400, min = 50, max = 16000, unit = "pixels", help = "of the picture's sides"},
}

local disk = venule.domain.disk {radius = 0.5}
local s = venule.vessels {
  domain = disk, rng = venule.rng(p.seed), steps = p.steps, growth = p.growth, darts = p.darts, avoid = p.avoid,
  murray_exponent = p.murray_exponent, bias = p.bias, bifurcation_threshold = p.bifurcation_threshold,
  perception_angle = p.perception_angle, perception_distance = p.perception_distance, satisfaction = p.satisfaction,
  segment_length = p.segment_length, drain_spacing = p.drain_spacing, drain_clearance = p.drain_clearance,
  arteries = {roots = {{-0.5, 0}}},
  veins = {roots = {{-0.49, -0.09}}, perception_distance = p.vein_perception_distance},
}
s:run {progress = true}

venule.result {
  networks = s.networks, view = disk:bounds(), width = p.size, background = "#ffffff",
  picture = function(page)
    page:stroke(s.veins, {color = "#3f6aa8"})
    page:stroke(s.arteries, {color = "#c23b2e"})
  end,
}
