-- Vessels that fill a ball, through a camera:  venule run scripts/ball.lua -o ball.png
-- Arteries and veins grow from opposite poles, each towards points of its own (Runions' space colonisation in space, with
-- widths by Murray's law). `--set turn=90` walks round the organ.
local venule = require "venule"

local p = venule.param {
  {"attractors", 3000, min = 10, max = 200000, help = "points that each of the two trees grows to"},
  {"exponent", 2.7, min = 2, max = 4, help = "Murray's"},
  {"turn", 30.0, min = -360, max = 360, unit = "degrees", help = "from where the ball is seen"},
  {"fog", 0.55, min = 0, max = 1, help = "how much what is far fades"},
  {"size", 1200, min = 50, max = 8000, unit = "pixels", help = "of the picture's sides"},
}

local organ = venule.domain.sphere {radius = 50}
local spacing = 1.1 * (organ:measure() / p.attractors) ^ (1 / 3) / 2

local function grow(pole, seed)
  local net, points = venule.network {dim = 3}, venule.attractors {dim = 3}
  points:throw {domain = organ, count = p.attractors, spacing = spacing, rng = venule.rng(seed)}
  net:root(0, pole, 0)
  repeat
    local added = net:extend(points:influence(net), {length = spacing / 3})
    points:consume(net, {distance = spacing})
    venule.frame()
  until added == 0
  net:murray {exponent = p.exponent, tip_radius = spacing / 24}
  return net
end

local arteries, veins = grow(-50, 2 * p.seed), grow(50, 2 * p.seed + 1)
local angle = math.rad(p.turn)

venule.result {
  networks = {arteries = arteries, veins = veins},
  view = organ:bounds(),
  width = p.size,
  background = "#fbfaf6",
  camera = {from = {230 * math.sin(angle), 70, 230 * math.cos(angle)}, to = {0, 0, 0}, fov = 27, fog = p.fog},
  picture = function(page)
    page:stroke(arteries, {color = "#c23b2e"})
    page:stroke(veins, {color = "#3f6aa8"})
  end,
}
