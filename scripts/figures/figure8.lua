-- Figure 8: three neighborhoods of a source s. Urquhart's has v in it, as a, which is nearer to both, is no Delaunay neighbor.
local venule = require "venule"
local pen = require "pen"

local s = {0.2, 0.5}
local nodes = {{0.38, 0.18}, {0.94, 0.56}, {0.58, 0.81}, {0.62, 0.33}, {0.49, 0.29}}
local V, A = 3, 4 -- the third is the paper's v, the fourth its a

local veins, auxin = venule.network {}, venule.attractors {}
for _, p in ipairs(nodes) do veins:root(p[1], p[2]) end
auxin:add(s[1], s[2])

local function influenced(mode)
  local list = {}
  for _, node in auxin:influence(veins, {mode = mode}):pairs() do list[#list + 1] = node end
  return list
end

-- The circle through s, p and q.
local function circumcircle(p, q)
  local ax, ay, bx, by = p[1] - s[1], p[2] - s[2], q[1] - s[1], q[2] - s[2]
  local cross, a2, b2 = 2 * (ax * by - ay * bx), ax * ax + ay * ay, bx * bx + by * by
  local x, y = (by * a2 - ay * b2) / cross, (ax * b2 - bx * a2) / cross
  return s[1] + x, s[2] + y, math.sqrt(x * x + y * y)
end

local function is_empty(x, y, r)
  for _, p in ipairs(nodes) do
    if math.sqrt((p[1] - x) ^ 2 + (p[2] - y) ^ 2) < r - 1e-9 then return false end
  end
  return true
end

-- Those that share an empty circle with s and another node.
local function delaunay()
  local list = {}
  for i, p in ipairs(nodes) do
    local found = false
    for j, q in ipairs(nodes) do found = found or i ~= j and is_empty(circumcircle(p, q)) end
    if found then list[#list + 1] = i end
  end
  return list
end

local function panel(page, x, title, neighbors)
  local here = pen.at(page, x, 0)
  for _, i in ipairs(neighbors) do here:line({s, nodes[i]}, "#2b2b2b", 0.008) end
  for i, p in ipairs(nodes) do
    here:disk(p[1], p[2], 0.018, "#2b2b2b")
    here:text(i == V and "v" or i == A and "a" or "", p[1] + 0.045, p[2] + 0.02, 20)
  end
  here:disk(s[1], s[2], 0.021, "#c0392b")
  here:text("s", s[1] - 0.05, s[2] - 0.01, 20)
  here:text(title, 0.55, 0.02, 18)
end

-- Where a node would be nearer to s and to v than these are to each other.
local function lune(page, x)
  local v = nodes[V]
  local d = math.sqrt((v[1] - s[1]) ^ 2 + (v[2] - s[2]) ^ 2)
  local function disk(c) return venule.domain.disk {center = {c[1] + x, c[2]}, radius = d} end
  page:fill(disk(s) * disk(v), {color = "#f4cfcb"})
end

venule.result {
  width = 1300, background = "#fdfcf7", view = {min = {0.05, -0.05}, max = {3.3, 1.15}},
  picture = function(page)
    panel(page, 0, "Delaunay", delaunay())
    panel(page, 1.1, "Urquhart", influenced "urquhart")
    lune(page, 2.2)
    panel(page, 2.2, "relative", influenced "relative")
  end,
}
