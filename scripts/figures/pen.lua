-- What the figures are drawn with: lines, circles and arrows about a place on the page. `pen.at(page, x, y)` is such a place;
-- lengths are those of the page's view.
local venule = require "venule"

local pen = {}
pen.__index = pen

function pen.at(page, x, y, scale)
  return setmetatable({page = page, x = x, y = y, scale = scale or 1}, pen)
end

function pen:place(points)
  local placed = {}
  for i, p in ipairs(points) do placed[i] = {self.x + self.scale * p[1], self.y + self.scale * p[2]} end
  return placed
end

--- A line through points; with `dashes`, every other piece of it is left out.
function pen:line(points, color, width, dashes)
  local line, last = venule.network {}, nil
  for i, p in ipairs(self:place(points)) do
    local drawn = last and not (dashes and i % 2 == 1)
    last = drawn and line:add(last, p[1], p[2]) or line:root(p[1], p[2])
  end
  self.page:stroke(line, {color = color, width = width})
end

--- `options` are those of canvas:fill.
function pen:fill(points, options)
  self.page:fill(venule.domain.polygon(self:place(points)), options)
end

local function circle(x, y, r)
  local points = {}
  for i = 0, 96 do
    local angle = 2 * math.pi * i / 96
    points[#points + 1] = {x + r * math.cos(angle), y + r * math.sin(angle)}
  end
  return points
end

function pen:circle(x, y, r, color, width, dashes)
  self:line(circle(x, y, r), color, width, dashes)
end

function pen:disk(x, y, r, color, opacity)
  local center = self:place {{x, y}}[1]
  self.page:fill(venule.domain.disk {center = center, radius = r * self.scale}, {color = color, opacity = opacity})
end

function pen:arrow(x1, y1, x2, y2, color, width)
  local length = math.sqrt((x2 - x1) ^ 2 + (y2 - y1) ^ 2)
  local ux, uy, head = (x2 - x1) / length, (y2 - y1) / length, 5 * width / self.scale
  local bx, by = x2 - head * ux, y2 - head * uy
  self:line({{x1, y1}, {bx, by}}, color, width)
  self:fill({{x2, y2}, {bx - head * uy / 2, by + head * ux / 2}, {bx + head * uy / 2, by - head * ux / 2}}, {color = color})
end

function pen:text(text, x, y, size, anchor)
  self.page:text(text, {at = self:place({{x, y}})[1], size = size or 16, anchor = anchor or "middle"})
end

--- A sector of a ring about (x, y), between two radii and two angles in degrees.
function pen:sector(x, y, inner, outer, from, to, options)
  local points, steps = {}, math.max(8, math.ceil(math.abs(to - from) / 2))
  for i = 0, 2 * steps + 1 do
    local out = i <= steps
    local angle = math.rad(out and from + (to - from) * i / steps or to + (from - to) * (i - steps - 1) / steps)
    local r = out and outer or inner
    if r > 0 or i <= steps + 1 then points[#points + 1] = {x + r * math.cos(angle), y + r * math.sin(angle)} end
  end
  self:fill(points, options)
end

--- Draw a network here. Its radii become those of Murray's law.
function pen:network(network, law, options)
  local copy, here = venule.network {murray = law}, {}
  local stack = {}
  for i = 1, #network do
    if network.parent[i] == 0 then stack[#stack + 1] = i end
  end
  while #stack > 0 do
    local i = table.remove(stack)
    local p, above = self:place({{network.x[i], network.y[i]}})[1], here[network.parent[i]]
    here[i] = above and copy:add(above, p[1], p[2]) or copy:root(p[1], p[2])
    for _, child in ipairs(network:children(i)) do stack[#stack + 1] = child end
  end
  self.page:stroke(copy, options)
end

return pen
