-- Arteries and veins that grow through a liver, in a mesh of a real one:  venule run scripts/liver_vessels.lua -o liver.png
-- Both begin at the hollow between the lobes; `-o liver.json` writes both networks. `--set on=surface` keeps them on the
-- capsule, `--set turn=90` walks round it.
local venule = require "venule"
local front = require "figures.front"

local p = venule.param {
  {"on", "inside", choices = {"inside", "surface"}, help = "where the vessels grow"},
  {"steps", 100, min = 1, max = 2000, help = "how many; the organ grows in each"},
  {"darts", 1000, min = 1, max = 10000000, help = "thrown in each step"},
  {"drain_clearance", 12.0, min = 0.5, max = 60, unit = "mm", help = "ε_n: how near new drains may be to arteries, at first"},
  {"bias", 0.5, min = 0, max = 1, help = "ω: how straight vessels grow"},
  {"murray_exponent", 2.7, min = 2.01, max = 4, help = "κ"},
  {"avoid", false, help = "arteries and veins keep clear of one another"},
  {"turn", 0.0, min = -360, max = 360, unit = "degrees", help = "from where it is seen"},
  {"size", 1600, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}

local liver = venule.domain.mesh("data/liver.obj", {on = p.on})
local capsule = venule.domain.mesh("data/liver.obj")
local bounds = liver:bounds()
local function middle(k) return (bounds.min[k] + bounds.max[k]) / 2 end

-- The hollow is the point of the capsule that is nearest to the middle; a root inside stands a little way in from it.
local function root(dx, dy)
  local x, y, z = capsule:closest(middle(1) + dx, middle(2) + dy, middle(3))
  return {x, y, z}
end

local e = p.drain_clearance
local s = venule.vessels {
  domain = liver, rng = venule.rng(p.seed), steps = p.steps, darts = p.darts, unit = "mm", avoid = p.avoid,
  drain_clearance = e, drain_spacing = 0.75 * e, satisfaction = 0.75 * e, segment_length = 0.6 * e,
  perception_distance = 1.8 * e, tip_radius = 0.025 * e, bias = p.bias, murray_exponent = p.murray_exponent,
  arteries = {roots = {root(0, 0)}},
  veins = {roots = {root(8, 8)}, perception_distance = 3 * e},
}
s:run {progress = true}

local angle = math.rad(p.turn)
local eye = {middle(1) + 500 * math.sin(angle), middle(2) + 100, middle(3) + 500 * math.cos(angle)}

-- On the capsule, what lies in front is drawn over it whole: the straight segments sink into its facets.
local solid = p.on == "surface" and venule.domain.mesh("data/liver.obj", {on = "inside"})
local function style(net, color)
  return {
    color = color, min_width = 0.6, width = solid and front.width(net, solid, eye) or "radius", hide_below = solid and 0.01 or nil,
    opacity = solid and 0.99 or 1,
  }
end

venule.result {
  networks = s.networks, view = bounds, width = p.size, background = "#ffffff",
  picture = function(page)
    page:fill(capsule, {color = "#d9a79a", opacity = p.on == "inside" and 0.25 or 1})
    page:stroke(s.veins, style(s.veins, "#3f6aa8"))
    page:stroke(s.arteries, style(s.arteries, "#c23b2e"))
  end,
  camera = {from = eye, to = {middle(1), middle(2), middle(3)}, fov = 30, zoom = 1.25, fog = 0.4},
}
