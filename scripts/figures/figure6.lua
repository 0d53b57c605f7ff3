-- Figure 6: one turn of the algorithm for open venation, step by step, made by the same primitives that grow a leaf.
local venule = require "venule"
local pen = require "pen"

local BIRTH, KILL, SEGMENT = 1.35, 1.0, 1.0
local outline = venule.leaf.outline("entire", {length = 1, width = 0.78, widest = 0.42})
local blade = venule.growth.marginal {domain = venule.domain.polygon(outline), origin = {0, 0}, from = 6, to = 7.2, step = 1.2}
local veins, auxin = venule.network {}, venule.attractors {}

local midvein = veins:root(0, 0.5)
for y = 1.5, 2.5 do midvein = veins:add(midvein, 0, y) end
for _, s in ipairs {{-0.5, 3.6}, {0.5, 4.9}, {1.5, 2.3}, {-1.35, 1.55}} do auxin:add(s[1], s[2]) end

local RED, VIOLET, DARK = "#c0392b", "#8e44ad", "#2b2b2b"
local here, page

local function panel(i, letter)
  here = pen.at(page, 6.6 * ((i - 1) % 4), -8.6 * ((i - 1) // 4))
  local points = {}
  for k, p in ipairs(outline) do points[k] = {p[1] * blade.length, p[2] * blade.length} end
  here:fill(points, {color = "#e6efd4", stroke = "#6f9150", line_width = 0.06})
  here:text(letter, -2.7, 6.3, 22)
end

local function draw_veins()
  for i = 1, #veins do
    local j = veins.parent[i]
    if j > 0 then here:line({{veins.x[j], veins.y[j]}, {veins.x[i], veins.y[i]}}, DARK, 0.09) end
  end
  for i = 1, #veins do
    here:disk(veins.x[i], veins.y[i], 0.2, DARK)
    here:disk(veins.x[i], veins.y[i], 0.1, "#ffffff")
  end
end

local function draw_sources()
  for i = 1, #auxin do here:disk(auxin.x[i], auxin.y[i], 0.17, RED) end
end

local function state(i, letter)
  panel(i, letter)
  draw_veins()
  draw_sources()
end

local function draw_influence()
  local influence = auxin:influence(veins)
  for s, v in influence:pairs() do here:line({{auxin.x[s], auxin.y[s]}, {veins.x[v], veins.y[v]}}, RED, 0.05) end
  return influence
end

-- Equation 1: unit vectors toward the sources, and their normalised sums, by the node that they influence.
local function directions(influence)
  local unit, sum = {}, {}
  for s, v in influence:pairs() do
    local dx, dy = auxin.x[s] - veins.x[v], auxin.y[s] - veins.y[v]
    local d = math.sqrt(dx * dx + dy * dy)
    unit[#unit + 1] = {v, dx / d, dy / d}
    sum[v] = {(sum[v] and sum[v][1] or 0) + dx / d, (sum[v] and sum[v][2] or 0) + dy / d}
  end
  return unit, sum
end

local function draw_unit_vectors(unit)
  for _, u in ipairs(unit) do
    local x, y = veins.x[u[1]], veins.y[u[1]]
    here:arrow(x, y, x + u[2], y + u[3], DARK, 0.06)
  end
end

local function draw_sums(sum)
  for v = 1, #veins do
    if sum[v] then
      local n = math.sqrt(sum[v][1] ^ 2 + sum[v][2] ^ 2)
      local x, y = veins.x[v] + SEGMENT * sum[v][1] / n, veins.y[v] + SEGMENT * sum[v][2] / n
      here:arrow(veins.x[v], veins.y[v], x, y, VIOLET, 0.07)
      here:circle(x, y, 0.2, VIOLET, 0.06)
    end
  end
end

local function far_from(points, x, y, distance)
  for i = 1, #points do
    if (points.x[i] - x) ^ 2 + (points.y[i] - y) ^ 2 < distance * distance then return false end
  end
  return true
end

local function draw_kill_zones()
  for i = 1, #auxin do
    local reached = not far_from(veins, auxin.x[i], auxin.y[i], KILL)
    here:circle(auxin.x[i], auxin.y[i], KILL, RED, reached and 0.12 or 0.04)
  end
end

local function draw_candidates(candidates)
  for _, c in ipairs(candidates) do
    here:circle(c[1], c[2], BIRTH, "#d98880", 0.05, true)
    here:circle(c[1], c[2], 0.17, RED, 0.06)
  end
end

local function steps(canvas)
  page = canvas
  state(1, "a")

  state(2, "b")
  local influence = draw_influence()
  local unit, sum = directions(influence)

  state(3, "c")
  draw_unit_vectors(unit)

  state(4, "d")
  draw_sums(sum)

  veins:extend(influence, {length = SEGMENT, domain = blade})
  state(5, "e")

  state(6, "f")
  draw_kill_zones()

  auxin:consume(veins, {distance = KILL})
  state(7, "g")

  blade:advance(veins, auxin)
  state(8, "h")

  local candidates = {{-1.6, 3.4}, {1.75, 3.35}, {-1.1, 0.9}} -- darts that fell here
  state(9, "i")
  draw_candidates(candidates)

  for _, c in ipairs(candidates) do
    if far_from(auxin, c[1], c[2], BIRTH) and far_from(veins, c[1], c[2], BIRTH) then auxin:add(c[1], c[2]) end
  end
  state(10, "j")

  state(11, "k")
  draw_influence()
end

venule.result {width = 1200, background = "#fdfcf7", view = {min = {-3.3, -17.8}, max = {23.1, 7.6}}, picture = steps}
