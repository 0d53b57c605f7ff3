-- Leaf outlines: what every shape promises, over sweeps of its options, which are read from the rows themselves.
local venule = require "venule"
local lu = require "luaunit"

local leaf = venule.leaf
local STAR = {"entire", "toothed", "poplar", "orchid", "petal", "linear", "cordate", "digitate", "reniform", "fan"}
local ALL = {"lobed", table.unpack(STAR)}

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- The values that a row is tried at: all choices, both ends of its range and a point between; odd counts.
local function values_of(row)
  if row.choices then return row.choices end
  if row[1] == "length" then return {1, 70} end
  if row[1] == "width" then return {0.05, 1, 20} end
  if row[1] == "teeth" then return {{{30, 0.02, 0.7}}, {{3, 0.1, 0.1}, {50, 0.05, 0.9}}} end
  if row.type == "integer" then return {row.min, row.min + 2, row.max} end
  return {row.min, row.min + 0.37 * (row.max - row.min), row.max}
end

-- Every pair of options at every pair of their values.
local function sweep(name, visit)
  local rows = venule.leaf_shapes[name].rows
  for i, a in ipairs(rows) do
    for j = i + 1, #rows do
      for _, av in ipairs(values_of(a)) do
        for _, bv in ipairs(values_of(rows[j])) do visit {[a[1]] = av, [rows[j][1]] = bv} end
      end
    end
    venule.frame()
  end
end

local function told(o)
  local parts = {}
  for key, value in pairs(o) do parts[#parts + 1] = key .. " = " .. tostring(value) end
  return table.concat(parts, ", ")
end

local function sum_area(points)
  local sum = 0
  for i, p in ipairs(points) do
    local q = points[i % #points + 1]
    sum = sum + p[1] * q[2] - q[1] * p[2]
  end
  return sum / 2
end

function TestSimpleOverSweeps()
  for _, name in ipairs(ALL) do
    sweep(name, function(o)
      local ok, blade = pcall(leaf[name], o)
      lu.assertTrue(ok, ("%s{%s}: %s"):format(name, told(o), blade))
      lu.assertTrue(blade:measure() > 0)
    end)
  end
end

function TestPetioleSeesTheMarginOverSweeps()
  for _, name in ipairs(STAR) do
    sweep(name, function(o)
      local ok, why = pcall(venule.growth.marginal, {domain = leaf[name](o), origin = {0, 0}})
      lu.assertTrue(ok, ("%s{%s}: %s"):format(name, told(o), tostring(why)))
    end)
  end
  lu.assertFalse((pcall(venule.growth.marginal, {domain = leaf.lobed {}, origin = {0, 0}})), "lobed is not star-shaped")
end

function TestPetioleAndTip()
  for _, name in ipairs(ALL) do
    sweep(name, function(o)
      if name ~= "lobed" then o.teeth = {} end -- teeth may stand above the tip
      local points = leaf.outline(name, o)
      local length = o.length or 1
      local tip = -math.huge
      for _, p in ipairs(points) do tip = math.max(tip, p[2]) end
      lu.assertEquals(points[1], {0, 0})
      lu.assertAlmostEquals(tip, length, 1e-9 * length, name .. ": " .. told(o))
      lu.assertTrue(sum_area(points) > 0, "counterclockwise")
    end)
  end
  for _, name in ipairs(ALL) do
    local box = leaf[name] {length = 30}:bounds()
    lu.assertAlmostEquals(box.max[2], 30, 1e-9, name)
  end
end

function TestMirrored()
  for _, name in ipairs(ALL) do
    local points = leaf.outline(name, name ~= "lobed" and {teeth = {{11, 0.02, 0.8}}} or {})
    local n = #points
    for i = 2, n do
      local p, q = points[i], points[n + 2 - i]
      lu.assertEquals({-p[1], p[2]}, {q[1], q[2]})
    end
  end
end

function TestWidth()
  for _, name in ipairs(ALL) do
    if name ~= "toothed" and name ~= "poplar" then -- their teeth stand out from it
      local box = leaf[name] {length = 10, width = 7}:bounds()
      lu.assertAlmostEquals(box.max[1] - box.min[1], 7, 0.01, name)
    end
  end
end

function TestAreasThatAreKnown()
  -- Two quarter ellipses a side: π/4 · length · width.
  lu.assertAlmostEquals(leaf.entire {length = 2, width = 1, tip = "rounded"}:measure(), math.pi / 2, 1e-3)
  -- Nearly a rectangle.
  lu.assertAlmostEquals(leaf.linear {length = 10, width = 1, taper = 0.01}:measure(), 10, 0.05)
end

function TestHeartHangs()
  for _, lobe in ipairs {0.05, 0.17, 0.5} do
    lu.assertAlmostEquals(leaf.cordate {length = 10, lobe = lobe}:bounds().min[2], -10 * lobe, 1e-6)
  end
  lu.assertFalse(leaf.cordate {}:contains(0, -0.05), "the notch")
  lu.assertTrue(leaf.cordate {}:contains(0.2, -0.05), "a lobe")
end

-- A circle through the petiole; how often its distance from the centre is greatest.
local function circle(n, clockwise)
  local points = {}
  for i = 0, n - 1 do
    local angle = 2 * math.pi * i / n * (clockwise and -1 or 1) - math.pi / 2
    points[#points + 1] = {math.cos(angle), 1 + math.sin(angle)}
  end
  points[1] = {0, 0}
  return points
end

local function crests(points)
  local count, n = 0, #points
  local function r(i) local p = points[(i - 1) % n + 1] return p[1] ^ 2 + (p[2] - 1) ^ 2 end
  for i = 1, n do
    if r(i) > r(i - 1) + 1e-9 and r(i) > r(i + 1) + 1e-9 then count = count + 1 end
  end
  return count
end

function TestTeethAreCounted()
  for _, clockwise in ipairs {false, true} do
    for _, count in ipairs {1, 7, 40} do
      lu.assertEquals(crests(leaf.teeth(circle(4000, clockwise), {{count, 0.003, 0.6}})), 2 * count)
    end
  end
  lu.assertEquals(crests(circle(4000)), 0, "a circle is even to the tolerance")
end

function TestTeethHaveTheirDepth()
  local most = 0
  for _, p in ipairs(leaf.teeth(circle(4000), {{9, 0.02, 0.5}})) do
    most = math.max(most, math.sqrt(p[1] ^ 2 + (p[2] - 1) ^ 2) - 1)
  end
  lu.assertAlmostEquals(most, 0.02 * 2, 1e-4) -- of the length, which is 2
end

function TestWavesAddUp()
  local most = 0
  for _, p in ipairs(leaf.teeth(circle(4000), {{9, 0.02, 0.5}, {27, 0.01, 0.5}})) do -- their crests coincide
    most = math.max(most, math.sqrt(p[1] ^ 2 + (p[2] - 1) ^ 2) - 1)
  end
  lu.assertAlmostEquals(most, 0.03 * 2, 1e-4)
end

function TestBaseOfGrass()
  local grass = leaf.linear {length = 100, width = 10}
  local seeds = leaf.base(grass, 5)
  lu.assertEquals(#seeds, 5)
  for i, p in ipairs(seeds) do
    lu.assertAlmostEquals(p[1], -5 + 2 * i - 1, 1e-6)
    lu.assertTrue(p[2] > 0 and p[2] < 1 and grass:contains(p[1], p[2]))
  end
end

function TestBaseIsInsideEveryBlade()
  for _, name in ipairs(ALL) do
    local blade = leaf[name] {length = 50}
    local growing = name ~= "lobed" and venule.growth.marginal {domain = blade, origin = {0, 0}, from = 5, to = 500}
    for _, n in ipairs {1, 2, 7} do
      for _, where in ipairs {blade, growing or blade} do
        local seeds = leaf.base(where, n)
        lu.assertEquals(#seeds, n)
        for i, p in ipairs(seeds) do
          lu.assertTrue(where:contains(p[1], p[2]), name)
          for j = 1, i - 1 do lu.assertTrue(seeds[j][1] ~= p[1] or seeds[j][2] ~= p[2], name .. ": two in one place") end
        end
      end
    end
  end
end

function TestErrors()
  fails(function() leaf.entire {widht = 3} end, 'leaf.entire: unknown field "widht", did you mean "width"?')
  fails(function() leaf.entire {widest = 2} end, "leaf.entire.widest = 2 must be from 0.05 to 0.95: where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)")
  fails(function() leaf.entire {tip = "blunt"} end, 'leaf.entire.tip = "blunt" must be one of rounded, acute, acuminate, caudate: caudate: drawn out into a tail')
  fails(function() leaf.digitate {count = 4} end, "leaf.digitate.count = 4 must be odd: the lobe in the middle is the tip")
  fails(function() leaf.reniform {count = 4} end, "leaf.reniform.count = 4 must be odd: the lobe in the middle is the tip")
  fails(function() return leaf.codate end, 'venule.leaf has no "codate", did you mean "cordate"?')
  fails(function() leaf.outline "gingko" end, 'leaf.outline: no shape "gingko"')
  fails(function() leaf.outline "entir" end, 'leaf.outline: no shape "entir", did you mean "entire"?')
  fails(function() leaf.entire {teeth = {{0, 0.1}}} end, "leaf.entire.teeth[1].count = 0 must be from 1 to 2000: teeth at each side")
  fails(function() leaf.teeth(leaf.outline "entire", {{5}}) end, "leaf.teeth[1]: `depth` is missing: height of a tooth, of the outline's length")
  fails(function() leaf.teeth({{0, 0}, {1, 1}}, {{5, 0.1}}) end, "leaf.teeth: an outline of at least 3 points expected, that starts at the petiole, below its tip")
  fails(function() leaf.teeth({{0, 0}, {1, "a"}, {0, 1}}, {{5, 0.1}}) end, "leaf.teeth: point 2: {x, y} expected, two numbers")
  fails(function() leaf.base(3, 1) end, "leaf.base: a domain expected, got number")
  fails(function() leaf.base(leaf.entire {}, 0) end, "leaf.base: n = 0 must be a whole number from 1 to 100000: how many nodes")
  fails(function() leaf.base(venule.domain.disk {center = {9, 9}}, 2) end, "leaf.base: the blade does not begin at its petiole (0, 0)")
end
