-- Rauch & Harders 2021, Figure 3: where drains are placed is where vessels grow. On the surface of a liver, inside it, or first on
-- the surface and then inwards from there: `--set where=surface`, `inside` or `combined`.
local venule = require "venule"
local front = require "front"

local p = venule.param {
  {"where", "surface", choices = {"surface", "inside", "combined"}, help = "left: the surface; right: the inside, or both"},
  {"steps", 120, min = 2, max = 1000, help = "of growth; half of them on the surface, where it is combined"},
  {"growth", 0.02, min = 0, max = 1, help = "Δσ"},
  {"darts", 4000, min = 1, max = 1000000, help = "thrown in each step"},
  {"turn", 17.0, min = -360, max = 360, unit = "degrees", help = "from where it is seen"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}

local mesh = "../data/liver.obj"
local surface = venule.domain.mesh(mesh, {on = "surface"})
local inside = venule.domain.mesh(mesh, {on = "inside"})
local bounds = surface:bounds()
local middle = {}
for k = 1, 3 do middle[k] = (bounds.min[k] + bounds.max[k]) / 2 end

local parts = {surface = {surface}, inside = {inside}, combined = {surface, inside}}
local stages = {}
for i, part in ipairs(parts[p.where]) do stages[i] = {steps = p.steps // #parts[p.where], domain = part} end

local s = venule.vessels {
  domain = inside, rng = venule.rng(p.seed), stages = stages, growth = p.growth, darts = p.darts, unit = "mm",
  drain_clearance = 12, drain_spacing = 9, satisfaction = 9, segment_length = 6, perception_distance = 18, tip_radius = 0.3,
  arteries = {roots = {{surface:closest(middle[1], middle[2], middle[3])}}}, -- in the hollow between the lobes
}
s:run {progress = true}

local angle, net = math.rad(p.turn), s.arteries
local eye = {middle[1] + 480 * math.sin(angle), middle[2] + 120, middle[3] + 480 * math.cos(angle)}
local seen = front.width(net, inside, eye)
venule.result {
  network = net, view = bounds, width = p.size, height = p.size * 0.8 // 1, background = "#ffffff",
  camera = {from = eye, to = middle, fov = 30, zoom = 1.25, fog = p.where == "surface" and 0 or 0.5},
  picture = function(page)
    if p.where == "surface" then
      page:fill(surface, {color = "#ecccc0"})
      page:stroke(net, {color = "#a81c16", width = seen, min_width = 0.5, hide_below = 0.01, opacity = 0.99})
      return
    end
    page:fill(surface, {color = "#e3b8a8", opacity = 0.25})
    page:stroke(net, {color = "#a81c16", min_width = 0.5})
  end,
}
