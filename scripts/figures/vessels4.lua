-- Rauch & Harders 2021, Figure 4: vessels that first follow paths of the user's (green), on the surface of a liver, and then go on
-- by themselves (red). `--set guides=FILE` takes other paths, of an .obj, .swc or .json file.
local venule = require "venule"
local front = require "front"

local p = venule.param {
  {"guides", "", file = true, help = "paths to follow; left out: three on the front of the liver"},
  {"steps", 100, min = 1, max = 1000, help = "of growth"},
  {"growth", 0.02, min = 0, max = 1, help = "Δσ"},
  {"darts", 1000, min = 1, max = 1000000, help = "thrown in each step"},
  {"only_guides", false, help = "grow nothing"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}

local liver = venule.domain.mesh("../data/liver.obj", {on = "surface"})
local inside = venule.domain.mesh("../data/liver.obj", {on = "inside"})
local bounds = liver:bounds()
local low, high = bounds.min, bounds.max
local middle = {(low[1] + high[1]) / 2, (low[2] + high[2]) / 2, (low[3] + high[3]) / 2}

-- A path as it is drawn on the picture, in shares of the bounds' width and height: on the side that is seen.
local function path(shares)
  local points = {}
  for i, s in ipairs(shares) do
    local x, y, z = low[1] + s[1] * (high[1] - low[1]), low[2] + s[2] * (high[2] - low[2]), high[3]
    while z > low[3] and not inside:contains(x, y, z) do z = z - 0.5 end
    points[i] = {x, y, z}
  end
  return points
end

local guides = p.guides ~= "" and venule.paths(p.guides) or {
  path {{0.52, 0.60}, {0.44, 0.55}, {0.34, 0.45}, {0.25, 0.34}, {0.17, 0.25}},
  path {{0.44, 0.55}, {0.34, 0.62}, {0.26, 0.74}, {0.23, 0.88}},
  path {{0.52, 0.60}, {0.55, 0.46}, {0.64, 0.33}, {0.76, 0.24}, {0.88, 0.15}},
}

local s = venule.vessels {
  domain = inside, rng = venule.rng(p.seed), growth = p.growth, darts = p.darts, unit = "mm", stages = {{steps = p.steps, domain = liver}},
  drain_clearance = 12, drain_spacing = 9, satisfaction = 9, segment_length = 6, perception_distance = 18, tip_radius = 0.3,
  arteries = {guides = guides},
}
local laid = venule.network {dim = 3, murray = {exponent = 100, tip_radius = 1}}
for i = 1, #s.arteries do
  local x, y, z = s.arteries.x[i], s.arteries.y[i], s.arteries.z[i]
  if s.arteries.parent[i] > 0 then laid:add(s.arteries.parent[i], x, y, z) else laid:root(x, y, z) end
end
if not p.only_guides then s:run {progress = true} end

local eye = {middle[1] + 150, middle[2] + 120, middle[3] + 480}
venule.result {
  network = s.arteries, view = bounds, width = p.size, height = p.size * 0.8 // 1, background = "#ffffff",
  camera = {from = eye, to = middle, fov = 30, zoom = 1.25},
  picture = function(page) -- a hundredth of transparency lays one over the other, however deep they lie in the organ's facets
    page:fill(liver, {color = "#ecccc0"})
    page:stroke(laid, {color = "#39b54a", width = front.width(laid, inside, eye, 2.4), hide_below = 0.01, opacity = 0.99})
    page:stroke(s.arteries, {color = "#a81c16", width = front.width(s.arteries, inside, eye), min_width = 0.5, hide_below = 0.01, opacity = 0.99})
  end,
}
