-- Leaf blades and petals as outlines with few parameters. The petiole is at (0, 0), the midrib is the y axis. Half an outline
-- runs from the petiole up the right side to the tip; the other half is its mirror image.
local venule = ...

local options = require "venule.options"

local SAMPLES = 120 -- of half an outline
local PI = math.pi

local length = {"length", 1, type = "number", above = 0, unit = "length", doc = "from the petiole to the tip"}
local teeth = {"teeth", nil, type = "table", doc = "waves of teeth along the margin, as venule.leaf.teeth has them"}

local function width(share)
  return {"width", nil, type = "number", above = 0, unit = "length", doc = ("where it is widest; left out: %s"):format(share)}
end

local function share(name, default, min, max, doc)
  return {name, default, type = "number", min = min, max = max, doc = doc}
end

-- Half widths between an end of the blade (u = 0) and where it is widest (u = 1, level there). Those of the base are concave:
-- then w(y) / y falls, and the petiole sees the whole margin.
local function superellipse(k)
  return function(u) return (1 - (1 - u) ^ k) ^ (1 / k) end
end

local function sine(power)
  return function(u) return math.sin(PI / 2 * u) ^ power end
end

local bases = {rounded = superellipse(2), truncate = superellipse(3.5), cuneate = sine(1)}
local tips = {
  rounded = superellipse(2), acute = function(u) return u * (2 - u) end, acuminate = sine(1.6),
  caudate = function(u) return 0.13 * math.sin(PI / 2 * u) + 0.87 * math.sin(PI / 2 * u) ^ 3.2 end,
}

-- From 0 to 1, denser at both ends, where outlines turn.
local function spaced(i, n)
  return 0.5 - 0.5 * math.cos(PI * i / n)
end

local FOOT = 12 -- points within the first step: a base that is cut off has most of its width there

local function profile(o, half_width)
  local half = {}
  local function add(t) half[#half + 1] = {o.width / 2 * half_width(t), o.length * t} end
  for i = 0, FOOT - 1 do add(spaced(1, SAMPLES) * (i / FOOT) ^ 4) end
  for i = 1, SAMPLES do add(spaced(i, SAMPLES)) end
  half[1], half[#half] = {0, 0}, {0, o.length}
  return half
end

local function blade_profile(o)
  local base, tip, widest = bases[o.base], tips[o.tip], o.widest
  return function(t) return t < widest and base(t / widest) or tip((1 - t) / (1 - widest)) end
end

local function simple(o)
  o.width = o.width or o.share * o.length
  return profile(o, blade_profile(o))
end

-- Half of r(angle), angles in radians from `from` to the tip at a right angle; scaled to its length, and to a width if given.
local function polar(o, from, radius, axes)
  local angles, half, widest = {}, {{0, 0}}, 0
  for i = 1, 2 * SAMPLES do angles[i] = from + (PI / 2 - from) * spaced(i, 2 * SAMPLES) end
  for _, axis in ipairs(axes or {}) do
    if axis > from and axis < PI / 2 then angles[#angles + 1] = axis end
  end
  table.sort(angles)
  local scale = 0
  for _, angle in ipairs(angles) do scale = math.max(scale, radius(angle) * math.sin(angle)) end
  for _, angle in ipairs(angles) do
    local r = radius(angle) * o.length / scale
    half[#half + 1] = {r * math.cos(angle), r * math.sin(angle)}
    widest = math.max(widest, half[#half][1])
  end
  half[#half][1] = 0
  if o.width then
    for _, p in ipairs(half) do p[1] = p[1] * o.width / (2 * widest) end
  end
  return half
end

-- Hang the base about the petiole: (x, y) sinks by an amount that rises with |x|, and fades toward the tip. Points of one x
-- keep their order, so an outline that was simple stays simple; what sinks by a concave function of x stays star-shaped.
local function hang(half, o)
  local function lowest(sink, write)
    local low = 0
    for _, p in ipairs(half) do
      local u, rest = 2 * p[1] / o.width, 1 - p[2] / o.length
      local y = p[2] - sink * u ^ 0.55 * rest ^ 3
      low = math.min(low, y)
      if write then p[2] = y end
    end
    return -low
  end
  local below, above = 0, o.length
  while lowest(above) < o.lobe * o.length do above = 2 * above end
  for _ = 1, 50 do
    local middle = (below + above) / 2
    if lowest(middle) < o.lobe * o.length then below = middle else above = middle end
  end
  lowest(above, true)
  return half
end

local function check_odd(name, count)
  if count % 2 == 0 then
    error(("leaf.%s.count = %d must be odd: the lobe in the middle is the tip"):format(name, count), 0)
  end
end

-- Lobes whose sides keep their angle to the ray from the petiole (logarithmic spirals), the larger radius at each angle.
local function palm(o)
  check_odd("digitate", o.count)
  local gap, middle = math.rad(o.spread) / (o.count - 1), (o.count - 1) / 2
  local steepness, sharp = -2 * math.log(o.sinus) / gap, 10 -- the less sharp, the rounder the bays
  local function radius(angle)
    local sum = 0
    for k = -middle, middle do
      local axis = math.abs(angle - PI / 2 - k * gap)
      sum = sum + ((1 - (1 - o.outer) * math.abs(k) / middle) * math.exp(-steepness * axis)) ^ sharp
    end
    return sum ^ (1 / sharp)
  end
  local lowest, axes = PI / 2 - middle * gap, {}
  for k = 1, middle do axes[k] = PI / 2 - k * gap end
  local from = math.max(lowest - 0.75 * gap, -0.49 * PI)
  return polar(o, from, function(angle)
    local heel = angle < lowest and ((angle - from) / (lowest - from)) ^ 0.4 or 1
    return radius(angle) * heel
  end, axes)
end

-- A round blade about its petiole, notched below, with shallow round lobes.
local function kidney(o)
  check_odd("reniform", o.count)
  local from = -math.rad(90 - o.sinus / 2)
  return polar(o, from, function(angle)
    local turned = (PI / 2 - angle) / (PI / 2 - from) -- 0 at the tip, 1 at the notch
    local body = (0.62 + 0.38 * math.cos(turned * PI / 2)) * (1 - turned ^ 12) ^ 0.5
    local scallop = math.abs(math.cos(o.count * PI / 2 * turned)) ^ 0.6
    return body * (1 - o.depth * (1 - scallop))
  end)
end

local function ginkgo(o)
  local half = math.rad(o.spread) / 2
  return polar(o, PI / 2 - half, function(angle)
    local turned = (PI / 2 - angle) / half
    local body = (1 - turned ^ 20) ^ 0.5
    local wave = 1 + o.wave * math.cos(9 * PI * turned) * (1 - turned)
    return body * wave * (1 - o.notch * math.exp(-(turned / 0.06) ^ 2))
  end)
end

-- Lobes off a midrib, bent toward the tip by moving points up along their x: no two that were apart can meet.
local function oak(o)
  o.width = o.width or 0.6 * o.length
  local body = blade_profile {base = "cuneate", tip = "rounded", widest = 0.6}
  local most = 0
  local half = profile(o, function(t)
    local w = body(t) * (1 - o.depth * (1 - (0.5 - 0.5 * math.cos(2 * PI * (o.count + 0.5) * t ^ 1.1)) ^ 0.7))
    most = math.max(most, w)
    return w
  end)
  for _, p in ipairs(half) do
    p[1] = p[1] / most
    p[2] = p[2] + 0.25 * p[1] / (o.width / 2) * (o.length - p[2]) * math.min(1, o.width / o.length)
  end
  return half
end

local function grass(o)
  o.width = o.width or 0.06 * o.length
  local half = profile(o, function(t)
    local u = (1 - t) / o.taper
    return u >= 1 and 1 or math.sin(PI / 2 * u) ^ 0.8
  end)
  table.insert(half, 2, {o.width / 2, 0})
  return half
end

local function outline_rows(default_share, widest, tip, base, default_teeth)
  return {
    length, width(("%g of the length"):format(default_share)),
    share("widest", widest, 0.05, 0.95, "where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)"),
    {"tip", tip, choices = {"rounded", "acute", "acuminate", "caudate"}, doc = "caudate: drawn out into a tail"},
    {"base", base, choices = {"cuneate", "rounded", "truncate"}, doc = "wedge-shaped, round, or cut off"},
    default_teeth and {"teeth", default_teeth, type = "table", doc = teeth.doc} or teeth,
  }, default_share
end

local shapes, names = {}, {}

local function shape(name, doc, half, rows, default_share)
  names[#names + 1] = name
  shapes[name] = {name = name, doc = doc, half = half, rows = rows, share = default_share}
end

shape("entire", "A blade with a smooth margin, from linear to round, ovate to obovate.", simple,
  outline_rows(0.5, 0.42, "acute", "rounded"))
shape("toothed", "The same with a toothed margin: small teeth upon large ones.", simple,
  outline_rows(0.6, 0.38, "acuminate", "rounded", {{9, 0.014, 0.6}, {36, 0.007, 0.6}}))
shape("poplar", "A blade broad at its foot with a drawn-out tip and small blunt teeth.", simple,
  outline_rows(0.85, 0.27, "acuminate", "truncate", {{24, 0.01, 0.6}}))
shape("orchid", "A lance-shaped blade of parallel veins.", simple, outline_rows(0.26, 0.45, "acute", "cuneate"))
shape("petal", "A petal of trillium: broadest above its middle, pointed, narrow at its foot.", simple,
  outline_rows(0.55, 0.56, "acute", "cuneate"))
shape("linear", "A grass blade; its base is as wide as the blade, for a row of seed nodes (venule.leaf.base).", grass, {
  length, width "0.06 of the length",
  share("taper", 0.6, 0.01, 1, "the share of the length in which it narrows to its tip"), teeth,
})
shape("cordate", "Heart-shaped: the base hangs below the petiole, at both sides of a notch.", function(o)
  return hang(simple(o), o)
end, {
  length, width "0.85 of the length",
  share("widest", 0.3, 0.1, 0.6, "where it is widest, before the base is hung"),
  share("lobe", 0.17, 0, 0.5, "how far the base hangs below the petiole, of the length"),
  {"tip", "acuminate", choices = {"rounded", "acute", "acuminate", "caudate"}, doc = "caudate: drawn out into a tail"},
  {"base", "truncate", choices = {"rounded", "truncate"}, doc = "of the blade before it is hung"}, teeth,
}, 0.85)
shape("digitate", "Lobes like fingers: maple, sweetgum. Each is a ray from the petiole.", palm, {
  length, width "as the lobes make it",
  {"count", 5, type = "integer", min = 3, max = 15, doc = "lobes; odd"},
  share("sinus", 0.42, 0.1, 0.9, "how near the petiole the bays between lobes come, of a lobe's length"),
  {"spread", 200, type = "number", min = 60, max = 280, unit = "degrees", doc = "between the outermost lobes"},
  share("outer", 0.7, 0.3, 1, "the length of the outermost lobes, of that in the middle"), teeth,
})
shape("reniform", "Kidney-shaped to round, with shallow round lobes: lady's mantle.", kidney, {
  length, width "as the lobes make it",
  {"count", 9, type = "integer", min = 3, max = 21, doc = "lobes; odd"},
  share("depth", 0.16, 0, 0.5, "of the bays between lobes, of the radius there"),
  {"sinus", 30, type = "number", min = 5, max = 180, unit = "degrees", doc = "how wide the notch at the petiole opens"}, teeth,
})
shape("fan", "A fan with straight sides and a notch at its top: ginkgo. Its length is that of the halves.", ginkgo, {
  length, width "as the fan opens",
  {"spread", 130, type = "number", min = 40, max = 300, unit = "degrees", doc = "between the two sides"},
  share("notch", 0.15, 0, 0.8, "depth of the notch, of the length"),
  share("wave", 0.015, 0, 0.1, "height of the waves of the margin, of the length"), teeth,
})
shape("lobed", "Lobes off a midrib: oak. Not star-shaped, so not a shape for growth.marginal.", oak, {
  length, width "0.6 of the length",
  {"count", 4, type = "integer", min = 1, max = 15, doc = "lobes at each side"},
  share("depth", 0.6, 0, 0.95, "of the bays, of the half width there"),
})

-- Teeth

local wave_rows = {
  {"count", nil, type = "integer", min = 1, max = 2000, required = true, doc = "teeth at each side"},
  {"depth", nil, type = "number", min = 0, max = 0.3, required = true, doc = "height of a tooth, of the outline's length"},
  {"skew", 0.5, type = "number", min = 0.02, max = 0.98, doc = "where a tooth is highest: 0.5 in its middle, above that toward the tip"},
}

local function read_waves(name, given, level)
  local waves = {}
  if type(given) ~= "table" then
    error(("%s: waves {{count, depth, skew}, …} expected, got %s"):format(name, type(given)), level + 1)
  end
  for i, row in ipairs(given) do
    local named = {}
    if type(row) ~= "table" then
      error(("%s[%d]: {count, depth, skew} expected, got %s"):format(name, i, type(row)), level + 1)
    end
    for key, value in pairs(row) do named[wave_rows[key] and wave_rows[key][1] or key] = value end
    waves[i] = options.read(("%s[%d]"):format(name, i), wave_rows, named, level + 1)
  end
  return waves
end

-- Teeth fade in from the petiole and out to the tip.
local FADE_IN, FADE_OUT = 0.12, 0.05

local function height(waves, s)
  local sum = 0
  for _, wave in ipairs(waves) do
    local u = wave.count * s % 1
    sum = sum + wave.depth * math.min(u / wave.skew, (1 - u) / (1 - wave.skew))
  end
  return sum * math.min(1, s / FADE_IN, (1 - s) / FADE_OUT)
end

-- Arc lengths along a side, from 0 to 1.
local function arcs(side)
  local at = {0}
  for i = 2, #side do at[i] = at[i - 1] + math.sqrt((side[i][1] - side[i - 1][1]) ^ 2 + (side[i][2] - side[i - 1][2]) ^ 2) end
  local total = at[#at]
  for i = 1, #at do at[i] = at[i] / total end
  return at
end

-- Every corner of the waves becomes a point.
local function marks(at, waves)
  local list, kept = table.move(at, 1, #at, 1, {}), {}
  for _, wave in ipairs(waves) do
    for k = 0, wave.count - 1 do
      list[#list + 1] = k / wave.count
      list[#list + 1] = (k + wave.skew) / wave.count
    end
  end
  table.sort(list)
  for _, s in ipairs(list) do
    if s - (kept[#kept] or -1) > 1e-6 then kept[#kept + 1] = s end
  end
  kept[#kept] = 1
  return kept
end

-- A walk along a side: the point at arc length s, for s that do not fall.
local function walker(side, at)
  local i = 1
  return function(s)
    while i < #at - 1 and at[i + 1] < s do i = i + 1 end
    local u = (s - at[i]) / (at[i + 1] - at[i])
    local a, b = side[i], side[i + 1]
    return a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])
  end
end

local function sees(side)
  local x, y = side[1][1], side[1][2]
  for i = 3, #side do
    local ax, ay, bx, by = side[i - 1][1] - x, side[i - 1][2] - y, side[i][1] - x, side[i][2] - y
    if ax * by - ay * bx < 0 then return false end
  end
  return true
end

-- What a tooth hides from the petiole is cut off along the line of sight, which turns from the base to the tip.
local function clear(side)
  local x, y = side[1][1], side[1][2]
  local function turn(p) return (math.atan(p[2] - y, p[1] - x) + PI / 2) % (2 * PI) - PI / 2 end
  local sight, last = -PI / 2, turn(side[#side])
  for i = 2, #side - 1 do
    local p = side[i]
    local r = math.sqrt((p[1] - x) ^ 2 + (p[2] - y) ^ 2)
    local angle = turn(p)
    local seen = angle < last + PI / 2 and angle or -PI / 2 -- past the line straight down
    seen = math.min(math.max(seen, sight + 1e-7), last - 1e-7 * (#side - i))
    if seen ~= angle then side[i] = {x + r * math.cos(seen), y + r * math.sin(seen)} end
    sight = seen
  end
end

-- Teeth on a side that has the blade on its left.
local function serrate(side, waves, size)
  local at, toothed = arcs(side), {}
  local before, here, after = walker(side, at), walker(side, at), walker(side, at)
  for i, s in ipairs(marks(at, waves)) do
    local ax, ay = before(math.max(0, s - 0.004))
    local bx, by = after(math.min(1, s + 0.004))
    local x, y = here(s)
    local run = math.sqrt((bx - ax) ^ 2 + (by - ay) ^ 2)
    local h = size * height(waves, s) / run
    toothed[i] = {x + h * (by - ay), y - h * (bx - ax)}
  end
  toothed[#toothed] = side[#side]
  if sees(side) then clear(toothed) end
  return toothed
end

local function mirrored(points)
  local list = {}
  for i, p in ipairs(points) do list[i] = {-p[1], p[2]} end
  return list
end

-- From two sides, both from the petiole to the tip, one ring.
local function ring_of(right, left)
  local ring = table.move(right, 1, #right, 1, {})
  for i = #left - 1, 2, -1 do ring[#ring + 1] = left[i] end
  return ring
end

local function half_of(found, given, level)
  local o = options.read("leaf." .. found.name, found.rows, given, level + 1)
  o.share = found.share
  local waves = o.teeth and read_waves("leaf." .. found.name .. ".teeth", o.teeth, level + 1)
  local ok, half = pcall(found.half, o)
  if not ok then error(half, level + 1) end
  return waves and serrate(half, waves, o.length) or half
end

local leaf = {}

--- The points {{x, y}, …} of a shape's outline, counterclockwise from the petiole.
function leaf.outline(name, given)
  if not shapes[name] then
    error(('leaf.outline: no shape "%s"%s'):format(tostring(name), options.suggestion(tostring(name), names)), 2)
  end
  local half = half_of(shapes[name], given or {}, 2)
  return ring_of(half, mirrored(half))
end

for _, name in ipairs(names) do
  leaf[name] = function(given)
    local half = half_of(shapes[name], given or {}, 2)
    return venule.domain.polygon(ring_of(half, mirrored(half)))
  end
end

local function area(points)
  local sum = 0
  for i, p in ipairs(points) do
    local q = points[i % #points + 1]
    sum = sum + p[1] * q[2] - q[1] * p[2]
  end
  return sum / 2
end

local function check_points(points, level)
  if type(points) ~= "table" then
    error("leaf.teeth: an outline {{x, y}, …} expected, got " .. type(points), level + 1)
  end
  for i, p in ipairs(points) do
    if type(p) ~= "table" or type(p[1]) ~= "number" or type(p[2]) ~= "number" then
      error(("leaf.teeth: point %d: {x, y} expected, two numbers"):format(i), level + 1)
    end
  end
end

--- Teeth upon an outline {{x, y}, …}, whose first point is the petiole and whose highest is the tip: sums of triangular waves
--- {{count, depth, skew}, …} along each side (Runions §3.2).
function leaf.teeth(points, given)
  local waves = read_waves("leaf.teeth", given, 2)
  check_points(points, 2)
  local top, low = 1, math.huge
  for i, p in ipairs(points) do
    if p[2] > points[top][2] then top = i end
    low = math.min(low, p[2])
  end
  if #points < 3 or top == 1 then
    error("leaf.teeth: an outline of at least 3 points expected, that starts at the petiole, below its tip", 2)
  end
  local size = points[top][2] - low
  local right = table.move(points, 1, top, 1, {})
  local left = {points[1]}
  for i = #points, top, -1 do left[#left + 1] = points[i] end
  if area(points) < 0 then right, left = left, right end
  return ring_of(serrate(right, waves, size), mirrored(serrate(mirrored(left), waves, size)))
end

-- Starting nodes

-- How far the blade reaches from (x, y) along x.
local function reach(blade, x, y, sign, most)
  local inside, outside = 0, nil
  for i = 1, 400 do
    local d = most * i / 400
    if not blade:contains(x + sign * d, y) then outside = d break end
    inside = d
  end
  if not outside then return inside end
  for _ = 1, 40 do
    local middle = (inside + outside) / 2
    if blade:contains(x + sign * middle, y) then inside = middle else outside = middle end
  end
  return inside
end

local function along(blade, x, y, n, most)
  local left, right = x - reach(blade, x, y, -1, most), x + reach(blade, x, y, 1, most)
  local points = {}
  for i = 1, n do points[i] = {left + (right - left) * (i - 0.5) / n, y} end
  return points
end

local function around(blade, x, y, n, r)
  local seen = {}
  for degrees = -90, 270 do
    local px, py = x + r * math.cos(math.rad(degrees)), y + r * math.sin(math.rad(degrees))
    if blade:contains(px, py) then seen[#seen + 1] = {px, py} end
  end
  local points = {}
  for i = 1, n do points[i] = seen[math.ceil((i - 0.5) / n * #seen)] end
  return points
end

--- n seed nodes for a blade: along its base, just inside; where it hangs below its petiole, on a small arc about that.
function leaf.base(blade, n)
  local class = type(blade) == "userdata" and getmetatable(blade).__name
  if class ~= "venule.domain" and class ~= "venule.growth" then
    error(("leaf.base: a domain expected, got %s"):format(class or type(blade)), 2)
  end
  if math.type(n) ~= "integer" or n < 1 or n > 100000 then
    error(("leaf.base: n = %s must be a whole number from 1 to 100000: how many nodes"):format(tostring(n)), 2)
  end
  local box = blade:bounds()
  local origin = class == "venule.growth" and blade.origin or {0, 0}
  local size = box.max[2] - box.min[2]
  local hangs = origin[2] - box.min[2] > 1e-6 * size
  local most = box.max[1] - box.min[1]
  local points = hangs and around(blade, origin[1], origin[2], n, 0.01 * size)
    or along(blade, origin[1], origin[2] + 0.002 * size, n, most)
  if not points[1] or not blade:contains(points[1][1], points[1][2]) then
    error(("leaf.base: the blade does not begin at its petiole (%g, %g)"):format(origin[1], origin[2]), 2)
  end
  return points
end

setmetatable(leaf, {__index = function(_, key)
  local known = {"outline", "teeth", "base", table.unpack(names)}
  error(('venule.leaf has no "%s"%s'):format(tostring(key), options.suggestion(tostring(key), known)), 2)
end})

return {leaf = leaf, leaf_shapes = shapes, leaf_names = names}
