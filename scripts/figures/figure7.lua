-- Figure 7: relative neighbors of a source s. No node may be in the green disk (nearer to s than v is) and nearer to v than s is;
-- nodes in the pink half (nearer to v than to s) and beyond the disk are excluded by v.
local venule = require "venule"
local pen = require "pen"

local s = {0, 0}
local names = {"v", "a", "b", "c", "d", "e"}
local nodes = {{1.0, 0.35}, {-0.75, 0.95}, {-0.35, -1.1}, {1.75, 1.1}, {2.05, -0.1}, {-1.35, 1.45}}

local veins, auxin = venule.network {}, venule.attractors {}
for _, p in ipairs(nodes) do veins:root(p[1], p[2]) end
auxin:add(s[1], s[2])

-- What is on the far side of the line half way to v, within the frame.
local function half_plane(v, reach)
  local mx, my, d = v[1] / 2, v[2] / 2, math.sqrt(v[1] ^ 2 + v[2] ^ 2)
  local nx, ny = v[1] / d, v[2] / d
  local function corner(along, out) return {mx - along * ny + out * nx, my + along * nx + out * ny} end
  return venule.domain.polygon {corner(-reach, 0), corner(-reach, reach), corner(reach, reach), corner(reach, 0)}
end

venule.result {
  width = 900, background = "#fdfcf7", view = {min = {-2.1, -1.7}, max = {2.7, 2.1}},
  picture = function(page)
    local here, v = pen.at(page, 0, 0), nodes[1]
    local near = venule.domain.disk {center = s, radius = math.sqrt(v[1] ^ 2 + v[2] ^ 2)}
    local frame = venule.domain.box {min = {-2.1, -1.7}, max = {2.7, 2.1}}
    page:fill(half_plane(v, 6) * frame, {color = "#f4cfcb"})
    page:fill(near, {color = "#bfe0b4", opacity = 0.9, stroke = "#5f9f50", line_width = 0.01})
    for _, node in auxin:influence(veins, {mode = "relative"}):pairs() do
      here:line({s, nodes[node]}, "#2b2b2b", 0.025)
    end
    for i, p in ipairs(nodes) do
      here:disk(p[1], p[2], 0.055, "#2b2b2b")
      here:text(names[i], p[1] + 0.13, p[2] + 0.03, 22)
    end
    here:disk(s[1], s[2], 0.065, "#c0392b")
    here:text("s", 0.02, -0.25, 22)
    here:text("1", -0.55, -0.35, 20)
    here:text("2", 2.3, 1.7, 20)
  end,
}
