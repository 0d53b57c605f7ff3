-- Rauch & Harders 2021, Figure 2: what a vessel's node perceives. a: the cone of a leaf, γ wide, around the direction it came by
-- (Equation 2). b: the spherical zone of an inter-node, γ wide on either side, around Murray's optimal branch at the angle α
-- (Equations 1 and 3). Red attraction points influence the node, grey ones do not: they are outside, or nearer to another node.
local venule = require "venule"
local pen = require "pen"

local p = venule.param {
  {"angle", 50.0, min = 1, max = 180, unit = "degrees", help = "γ"},
  {"murray_exponent", 2.55, min = 2.01, max = 4, help = "κ"},
  {"tips", 2, min = 1, max = 255, help = "that the vessel beyond the inter-node carries"},
  {"points", 90, min = 1, max = 10000, help = "attraction points around each node"},
  {"size", 1400, min = 100, max = 8000, unit = "pixels", help = "width of the picture"},
}

local REACH, DARK, RED, GREY, ZONE = 1, "#2b2b2b", "#c23b2e", "#a9a9a9", "#f6d9a8"
local perception = {angle = p.angle, lateral = true}

-- A vessel that comes from below; with `tips`, it goes on in a child that carries so many.
local function vessel(tips)
  local net = venule.network {murray = {exponent = p.murray_exponent, tip_radius = 0.02}}
  local i = net:root(-0.28, -0.85)
  local j = net:add(i, 0, 0)
  if tips then
    local x, y, child = 0.21, 0.64, net:add(j, 0.21, 0.64)
    for k = 1, tips - 1 do -- one to the left, and on to the right
      net:add(child, x - 0.2 / k, y + 0.4 / k)
      x, y = x + 0.32 / k, y + 0.32 / k
      child = net:add(child, x, y)
    end
  end
  return net, j
end

local function scatter(net)
  local points, rng = venule.attractors {}, venule.rng(p.seed)
  for _, q in ipairs(venule.domain.disk {radius = 1.25}:sample(p.points, {rng = rng, spacing = 0.08})) do points:add(q[1], q[2]) end
  return points, points:influence(net, {within = REACH, perception = perception})
end

local function draw_points(here, net, node)
  local points, influence = scatter(net)
  local drawn = {}
  for attractor, at in influence:pairs() do drawn[attractor] = at == node end
  for i = 1, #points do
    local color = drawn[i] and RED or GREY
    if drawn[i] then here:line({{0, 0}, {points.x[i], points.y[i]}}, RED, 0.006) end
    here:disk(points.x[i], points.y[i], 0.022, color)
  end
end

local function degrees(d) return math.deg(math.atan(d[2], d[1])) end

local function ray(here, angle, length, color, dashes)
  local line, pieces = {}, dashes and 24 or 1
  for i = 0, pieces do
    local r = length * i / pieces
    line[i + 1] = {r * math.cos(math.rad(angle)), r * math.sin(math.rad(angle))}
  end
  here:line(line, color, 0.012, dashes)
end

local function arc(here, radius, from, to, text, share)
  local line = {}
  for i = 0, 32 do
    local angle = math.rad(from + (to - from) * i / 32)
    line[#line + 1] = {radius * math.cos(angle), radius * math.sin(angle)}
  end
  here:line(line, DARK, 0.012)
  local middle = math.rad(from + (to - from) * share)
  here:text(text, (radius + 0.09) * math.cos(middle), (radius + 0.09) * math.sin(middle) - 0.03, p.size / 50)
end

local function zone_sector(here, middle, width)
  here:sector(0, 0, 0, REACH, middle - width / 2, middle + width / 2, {color = ZONE, stroke = "#c99a45", line_width = 0.008})
end

local function nodes(here, net, names)
  for i = 1, 2 do here:disk(net.x[i], net.y[i], 0.05, DARK) end
  here:text(names[1], net.x[1] + 0.16, net.y[1] - 0.04, p.size / 45)
  here:text(names[2], 0.16, -0.12, p.size / 45)
end

local function draw_leaf(here)
  local net, node = vessel()
  local zone = net:zone(node, perception)
  assert(zone.kind == "cone", zone.kind)
  local e = degrees(zone.direction)
  zone_sector(here, e, p.angle)
  draw_points(here, net, node)
  here:network(net, {exponent = p.murray_exponent, tip_radius = 0.03}, {color = RED})
  ray(here, e, 1.12, DARK, true)
  arc(here, 0.55, e - p.angle / 2, e + p.angle / 2, "γ", 0.25)
  here:arrow(0, 0, REACH * math.cos(math.rad(e - p.angle / 2)), REACH * math.sin(math.rad(e - p.angle / 2)), DARK, 0.012)
  here:text("δ", 0.8 * math.cos(math.rad(e - p.angle / 2)) + 0.09, 0.8 * math.sin(math.rad(e - p.angle / 2)) - 0.09, p.size / 50)
  nodes(here, net, {"i", "j"})
  here:text("a   leaf", -1.25, 1.3, p.size / 40, "start")
end

local function draw_inter(here)
  local net, node = vessel(p.tips)
  local zone = net:zone(node, perception)
  assert(zone.kind == "belt", zone.kind)
  local e = degrees(zone.direction)
  for _, side in ipairs {-1, 1} do zone_sector(here, e + side * zone.angle, p.angle) end
  draw_points(here, net, node)
  here:network(net, {exponent = p.murray_exponent, tip_radius = 0.02}, {color = RED})
  ray(here, e, 1.12, DARK, true)
  for _, side in ipairs {-1, 1} do
    local a = math.rad(e + side * zone.angle)
    here:arrow(0, 0, REACH * math.cos(a), REACH * math.sin(a), DARK, 0.012)
  end
  arc(here, 0.34, e, e - zone.angle, "α", 0.5)
  arc(here, 0.55, e + zone.angle - p.angle / 2, e + zone.angle + p.angle / 2, "γ", 0.25)
  nodes(here, net, {"i", "j"})
  here:text(("b   inter-node, α = %.1f°"):format(zone.angle), -1.25, 1.3, p.size / 40, "start")
end

venule.result {
  width = p.size, background = "#ffffff", view = {min = {-1.45, -1.4}, max = {4.45, 1.5}},
  picture = function(page)
    draw_leaf(pen.at(page, 0, 0))
    draw_inter(pen.at(page, 3, 0))
  end,
}
