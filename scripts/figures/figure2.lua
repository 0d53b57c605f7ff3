-- Figure 2: a leaf, and what four kinds of growth make of it. The lines are drawn in its tissue and go where that goes.
local venule = require "venule"
local pen = require "pen"

local growth, steps = venule.growth, 8
local outline = venule.leaf.outline("entire", {width = 0.6})
local blade = venule.domain.polygon(outline)

local leaves = {
  {"a  the leaf", growth.none {domain = blade}},
  {"b  marginal", growth.marginal {domain = blade, origin = {0, 0}, from = 1, to = 1.6, step = 0.6 / steps}},
  {"c  isogonic", growth.isogonic {domain = blade, origin = {0, 0}, from = 1, to = 1.6, step = 0.6 / steps}},
  {"d  uniform, anisotropic", growth.uniform {domain = blade, origin = {0, 0}, x = 2 ^ (1 / steps), y = 1.2 ^ (1 / steps), steps = steps}},
  {"e  not uniform", growth.rerg {
    domain = blade, origin = {0, 0}, steps = steps,
    x = function(y) return (0.9 + 1.1 * math.exp(-14 * (y - 0.3) ^ 2)) ^ (1 / steps) end,
    y = function(y) return (2.2 - 1.5 * y) ^ (1 / steps) end,
  }},
}

-- Lines of the grown leaf are where its tissue went; a margin that grows alone leaves them behind.
local function moved(leaf, points)
  local list = {}
  for i, p in ipairs(points) do
    local x, y = leaf:map(p[1], p[2], 0, leaf.time)
    list[i] = {x / leaf.unit, y / leaf.unit}
  end
  return list
end

local function margin(leaf, kind)
  if not kind:find "marginal" then return moved(leaf, outline) end
  local list = {}
  for i, p in ipairs(outline) do list[i] = {p[1] * leaf.length, p[2] * leaf.length} end
  return list
end

local function tissue(visit)
  local function line(x, y, dx, dy)
    local points = {}
    for i = 0, 200 do
      local px, py = x + dx * i / 200, y + dy * i / 200
      if blade:contains(px, py) then points[#points + 1] = {px, py} end
    end
    if #points > 1 then visit(points) end
  end
  for k = 1, 19 do line(-0.5, k / 20, 1, 0) end
  for k = -9, 9 do line(k / 20, 0, 0, 1) end
end

venule.result {
  width = 1400, background = "#fdfcf7", view = {min = {-0.5, -0.2}, max = {6.4, 1.7}},
  picture = function(page)
    for i, found in ipairs(leaves) do
      local name, leaf = table.unpack(found)
      local here = pen.at(page, 1.4 * (i - 1), 0)
      while leaf:advance() do end
      here:fill(margin(leaf, name), {color = "#dfe9c8", stroke = "#5f7f45", line_width = 0.012})
      tissue(function(points) here:line(moved(leaf, points), "#8aa36a", 0.005) end)
      here:fill(moved(leaf, outline), {color = "none", stroke = "#5f7f45", line_width = 0.008})
      here:text(name, 0, -0.13, 18)
    end
  end,
}
