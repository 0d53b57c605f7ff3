-- The arteries of a liver, in a mesh of a real one:  venule run scripts/liver_arteries.lua -o liver.png -o liver.vtp
-- Blood enters at the hollow between the lobes: a branch runs into each, and the finest end short of the capsule.
-- `--set turn=90` walks round it.
local venule = require "venule"

local p = venule.param {
  {"terminals", 4000, min = 1, max = 1000000, help = "ends of the tree"},
  {"inflow", 400.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "of the hepatic artery"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"border_distance", 1.0, min = 0, max = 20, unit = "mm", help = "that vessels keep from the capsule"},
  {"turn", 0.0, min = -360, max = 360, unit = "degrees", help = "from where it is seen"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}

local liver = venule.domain.mesh("data/liver.obj", {on = "inside"})
local capsule = venule.domain.mesh("data/liver.obj")
local bounds = liver:bounds()
local function middle(k) return (bounds.min[k] + bounds.max[k]) / 2 end

local tree = venule.cco {
  domain = liver, terminals = p.terminals, inflow = p.inflow * 1000 / 60, viscosity = p.viscosity,
  border_distance = p.border_distance, seed = p.seed, root = {liver:closest(middle(1), middle(2), middle(3))},
}
tree:run {progress = true}

local angle = math.rad(p.turn)
venule.result {
  network = tree.network, view = bounds, width = p.size, background = "#ffffff",
  picture = function(page)
    page:fill(capsule, {color = "#d9a79a", opacity = 0.25})
    page:stroke(tree.network, {color = "#b3201c", min_width = 0.5})
  end,
  camera = {from = {middle(1) + 500 * math.sin(angle), middle(2) + 100, middle(3) + 500 * math.cos(angle)},
    to = {middle(1), middle(2), middle(3)}, fov = 30, zoom = 1.25, fog = 0.4},
}
