-- Figure 5: growth from the narrow shape a to the round shape b, by growth factors along x (c) and along y (d) that depend on
-- where along the leaf the tissue was at first. The curves stand beside a: their heights are its heights.
local venule = require "venule"
local pen = require "pen"

local steps = 100
local function along_x(y) return 14 + 12 * math.exp(-((y - 0.15) / 0.4) ^ 2) end
local function along_y(y) return 6 + 6 * (1 - y) ^ 2 end -- 8 on the average

local outline = venule.leaf.outline("entire", {width = 0.26, tip = "rounded"})
local leaf = venule.growth.rerg {
  domain = venule.domain.polygon(outline), origin = {0, 0}, steps = steps,
  x = function(y) return along_x(y) ^ (1 / steps) end,
  y = function(y) return along_y(y) ^ (1 / steps) end,
}

local function at_time(t)
  local points = {}
  for i, p in ipairs(outline) do points[i] = {leaf:map(p[1], p[2], 0, t)} end
  return points
end

local function curve(here, f, label)
  local points = {}
  for i = 0, 100 do points[#points + 1] = {f(i / 100) / 10, 3 * i / 100} end
  here:arrow(0, 0, 2.9, 0, "#555555", 0.02)
  here:arrow(0, 0, 0, 3.5, "#555555", 0.02)
  here:line(points, "#b03a2e", 0.04)
  for _, factor in ipairs {5, 10, 15, 20, 25} do
    here:line({{factor / 10, 0}, {factor / 10, -0.08}}, "#555555", 0.02)
    here:text(tostring(factor), factor / 10, -0.38, 14)
  end
  here:text("y at first", 0.1, 3.55, 14, "start")
  here:text(label, 1.2, -0.9, 18)
end

venule.result {
  width = 1400, background = "#fdfcf7", view = {min = {-1.2, -1.2}, max = {17.2, 8.3}},
  picture = function(page)
    local blade = {color = "#dfe9c8", stroke = "#5f7f45", line_width = 0.04}
    local early = pen.at(page, 0.2, 0, 3)
    early:fill(outline, blade)
    early:text("a  at first, × 3", 0, -0.3, 18)
    curve(pen.at(page, 2.4, 0), along_x, "c  growth along x")
    curve(pen.at(page, 6.3, 0), along_y, "d  growth along y")
    local late = pen.at(page, 13.4, 0)
    late:fill(at_time(steps), blade)
    for k = 0, 3 do late:fill(at_time(steps * k / 4), {color = "none", stroke = "#a9bd8f", line_width = 0.03}) end
    late:text("b  at the end, and on the way", 0, -0.9, 18)
  end,
}
