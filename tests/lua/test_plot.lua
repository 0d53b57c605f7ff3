-- Plots: what is asked of the script, what stands at the axes, and that nothing covers the data. Read back from the SVG.
local venule = require "venule"
local lu = require "luaunit"

local NAN, INF = 0 / 0, math.huge

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

local function saved(canvas, extension)
  local path = os.tmpname()
  os.remove(path)
  path = path .. "." .. extension
  canvas:save(path)
  local file = assert(io.open(path, "rb"))
  local bytes = file:read "a"
  file:close()
  os.remove(path)
  return bytes
end

local function unescaped(text) return (text:gsub("&lt;", "<"):gsub("&gt;", ">"):gsub("&amp;", "&")) end

-- The texts of a plot: {text, x, y, anchor, turned}, y down.
local function texts_of(canvas)
  local list = {}
  for head, text in saved(canvas, "svg"):gmatch "<text([^>]*)>([^<]*)</text>" do
    list[#list + 1] = {
      text = unescaped(text), x = tonumber(head:match ' x="([%d.-]+)"'), y = tonumber(head:match ' y="([%d.-]+)"'),
      anchor = head:match 'text%-anchor="(%w+)"', turned = head:find "rotate" ~= nil, size = tonumber(head:match 'font%-size="([%d.]+)"'),
    }
  end
  return list
end

local function labels_of(canvas, anchor)
  local list = {}
  for _, text in ipairs(texts_of(canvas)) do
    if text.anchor == anchor and not text.turned then list[#list + 1] = text.text end
  end
  return list
end

-- Circles {x, y, r} and lines {{x, y}, …}, of the colour if one is given.
local function drawn_in(canvas, color)
  local svg, circles, lines = saved(canvas, "svg"), {}, {}
  for group in svg:gmatch "<g inkscape.-</g>\n" do
    if group:find(color, 1, true) then
      for x, y, r in group:gmatch '<circle cx="([%d.-]+)" cy="([%d.-]+)" r="([%d.]+)"' do
        circles[#circles + 1] = {tonumber(x), tonumber(y), tonumber(r)}
      end
      for path in group:gmatch ' d="([^"]*)"' do
        local line, x, y = {}, 0, 0
        for command, rest in path:gmatch "([Ml])([^Mlz]*)" do
          local numbers = {}
          for number in rest:gmatch "-?[%d.]+" do numbers[#numbers + 1] = tonumber(number) end
          for i = 1, #numbers, 2 do
            x, y = numbers[i] + (command == "l" and x or 0), numbers[i + 1] + (command == "l" and y or 0)
            line[#line + 1] = {x, y}
          end
        end
        lines[#lines + 1] = line
      end
    end
  end
  return circles, lines
end

local RED = "#aa1122" -- a colour that plots have not of their own

local function one(x, y, more)
  local s = {x = x, y = y, color = RED}
  for key, value in pairs(more or {}) do s[key] = value end
  return s
end

function testNumbersAtTheAxesAreNice()
  local p = venule.plot {series = {one({0, 10}, {0, 97})}}
  lu.assertEquals(labels_of(p, "middle"), {"0", "2", "4", "6", "8", "10"})
  lu.assertEquals(labels_of(p, "end"), {"0", "20", "40", "60", "80", "100"})
  p = venule.plot {series = {one({-0.35, 0.41}, {1e7, 3e7})}}
  lu.assertEquals(labels_of(p, "middle"), {"−0.2", "0", "0.2", "0.4"})
  lu.assertEquals(labels_of(p, "end"), {"1.0·10⁷", "1.5·10⁷", "2.0·10⁷", "2.5·10⁷", "3.0·10⁷"})
end

function testEveryTickIsWhereItsNumberSays()
  for _, range in ipairs {{0, 1}, {-3, 17}, {1e-5, 2.3e-5}, {-8e8, 3}, {99.9, 100.1}} do
    local p = venule.plot {series = {one({range[1], range[2]}, {1, 2})}}
    local ends = drawn_in(p, RED)
    local a, b = ends[1], ends[2]
    local count = 0
    for _, text in ipairs(texts_of(p)) do
      if text.anchor == "middle" and not text.turned then
        local mantissa, exponent = text.text:gsub("−", "-"):match "^([%d.-]+)·10(.*)$"
        local digits = {["⁰"] = 0, ["¹"] = 1, ["²"] = 2, ["³"] = 3, ["⁴"] = 4, ["⁵"] = 5, ["⁶"] = 6, ["⁷"] = 7, ["⁸"] = 8, ["⁹"] = 9, ["⁻"] = "-"}
        local power = exponent and tonumber((exponent:gsub(utf8.charpattern, digits))) or 0
        local value = tonumber(mantissa or (text.text:gsub("−", "-"))) * 10.0 ^ power
        local x = a[1] + (value - range[1]) / (range[2] - range[1]) * (b[1] - a[1])
        lu.assertAlmostEquals(text.x, x, 0.02 + math.abs(b[1] - a[1]) * 1e-6)
        count = count + 1
      end
    end
    lu.assertTrue(count >= 2 and count <= 10, ("%g to %g has %d numbers"):format(range[1], range[2], count))
  end
end

function testALogarithmicAxisHasPowersOfTen()
  local p = venule.plot {x = {log = true}, y = {log = true}, series = {one({0.05, 2000}, {1e-9, 1e12})}}
  lu.assertEquals(labels_of(p, "middle"), {"0.1", "1", "10", "100", "1000"})
  lu.assertEquals(labels_of(p, "end"), {"10⁻⁹", "10⁻⁶", "10⁻³", "10⁰", "10³", "10⁶", "10⁹", "10¹²"})
  p = venule.plot {y = {log = true}, series = {one({1, 2}, {1.5, 30})}}
  lu.assertEquals(labels_of(p, "end"), {"2", "5", "10", "20"})
  p = venule.plot {y = {log = true}, series = {one({1, 2}, {12, 13})}}
  lu.assertTrue(#labels_of(p, "end") >= 2)
end

function testALogarithmicAxisIsLogarithmic()
  local circles = drawn_in(venule.plot {y = {log = true}, series = {one({1, 2, 3}, {1, 10, 100})}}, RED)
  lu.assertEquals(#circles, 3)
  lu.assertAlmostEquals(circles[2][2], (circles[1][2] + circles[3][2]) / 2, 0.01)
end

function testZerosOnALogarithmicAxis()
  fails(function() venule.plot {y = {log = true}, series = {{x = {0, 1}, y = {3, 0}}}} end,
    "plot.series[1].y[2] = 0 has no place on a logarithmic axis: give values above 0, and NaN for what is missing")
  fails(function() venule.plot {x = {log = true}, series = {{x = {}, y = {}}, {x = {-2}, y = {0}}}} end,
    "plot.series[2].x[1] = -2 has no place on a logarithmic axis: give values above 0, and NaN for what is missing")
  fails(function() venule.plot {y = {log = true, min = 0}, series = {}} end, "plot.y.min = 0 must be above 0 on a logarithmic axis")
  venule.plot {y = {log = true}, series = {{x = {1, 2, 3}, y = {3, NAN, 4}, deviation = 100}}} -- the bars end at the frame
end

function testWhatIsMissingBreaksTheLine()
  local circles, lines = drawn_in(venule.plot {series = {one({1, 2, 3, 4, 5, 6, 7}, {1, 2, NAN, 3, 4, INF, 5})}}, RED)
  lu.assertEquals(#circles, 5)
  lu.assertEquals(#lines, 2)
  lu.assertEquals(#lines[1], 2)
end

function testNothingAtAll()
  for _, series in ipairs {{}, {one({}, {})}, {one({NAN}, {1})}, {one({}, {}, {label = "none"})}} do
    local p = venule.plot {series = series, title = "empty", x = {label = "x"}, y = {label = "y"}}
    lu.assertTrue(#saved(p, "png") > 100)
    lu.assertTrue(#labels_of(p, "end") >= 2)
  end
end

function testOnePoint()
  for _, value in ipairs {0, -3, 1e-140, 1e140} do
    local circles, lines = drawn_in(venule.plot {series = {one({value}, {value})}}, RED)
    lu.assertEquals(#circles, 1)
    lu.assertEquals(#lines, 0)
    lu.assertTrue(circles[1][1] > 40 and circles[1][1] < 640)
  end
  lu.assertEquals(#drawn_in(venule.plot {x = {log = true}, y = {log = true}, series = {one({7}, {1e-9})}}, RED), 1)
  venule.plot {series = {one({1e16, 1e16 + 2}, {1, 1 + 2e-16})}} -- a range that ends with the numbers' digits
  venule.plot {x = {min = 1e16, max = 1e16 + 2}, series = {}}
end

function testGivenLimitsHold()
  local x, y = {}, {}
  for i = 1, 40 do x[i], y[i] = i, 30 * math.sin(i) end
  local p = venule.plot {x = {min = 10, max = 20}, y = {min = -5, max = 5}, series = {one(x, y, {deviation = 3}), one(x, y, {deviation = 3, band = true})}}
  local circles, lines = drawn_in(p, RED)
  local frame = {left = INF, right = -INF, top = INF, bottom = -INF}
  for _, line in ipairs(select(2, drawn_in(p, "#e4e4e4"))) do
    for _, q in ipairs(line) do
      frame.left, frame.right = math.min(frame.left, q[1]), math.max(frame.right, q[1])
      frame.top, frame.bottom = math.min(frame.top, q[2]), math.max(frame.bottom, q[2])
    end
  end
  lu.assertTrue(#circles > 0 and #lines > 5)
  for _, line in ipairs(lines) do
    for _, q in ipairs(line) do
      lu.assertTrue(q[1] >= frame.left - 3.1 and q[1] <= frame.right + 3.1 and q[2] >= frame.top - 0.1 and q[2] <= frame.bottom + 0.1)
    end
  end
  for ring in saved(p, "svg"):gmatch '<path fill%-rule[^>]* d="([^"]*)"' do
    local first_x, first_y = ring:match "^M([%d.]+)[ ]?([%d.]+)"
    lu.assertTrue(tonumber(first_x) >= frame.left - 0.1 and tonumber(first_y) <= frame.bottom + 0.1)
  end
end

function testDeviationsAreBarsOrABand()
  local x, y = {1, 2, 3, 4}, {2, 3, 2, 4}
  local _, plain = drawn_in(venule.plot {series = {one(x, y)}}, RED)
  local _, bars = drawn_in(venule.plot {series = {one(x, y, {deviation = {1, 0, NAN, 0.5}})}}, RED)
  lu.assertEquals(#plain, 1)
  lu.assertEquals(#bars, 1 + 2 * 3) -- 0 and NaN have none
  local function drawn(below)
    return saved(venule.plot {y = {min = 0, max = 9}, series = {one(x, y, {deviation = 1, below = below})}}, "svg")
  end
  lu.assertEquals(drawn(1), drawn(nil))
  lu.assertNotEquals(drawn(0.25), drawn(nil))
  local band = saved(venule.plot {series = {one(x, y, {deviation = 1, band = true})}}, "svg")
  local _, areas = band:gsub("<path fill%-rule", "")
  lu.assertEquals(areas, 1)
end

-- Boxes of the legend's texts; whatever is drawn of the series elsewhere is not in them.
local function assert_legend_is_clear(p, labels)
  local circles, lines = drawn_in(p, RED)
  local found = 0
  for _, text in ipairs(texts_of(p)) do
    if labels[text.text] then
      found = found + 1
      local left, right = text.x - 2, text.x + venule.text_width(text.text, text.size) + 2
      local top, bottom = text.y - text.size, text.y + 0.3 * text.size
      for _, c in ipairs(circles) do
        lu.assertFalse(c[1] > left and c[1] < right and c[2] > top and c[2] < bottom, "a mark is under " .. text.text)
      end
      for _, line in ipairs(lines) do
        for i = 2, #line do
          for step = 0, 20 do
            local x = line[i - 1][1] + step / 20 * (line[i][1] - line[i - 1][1])
            local y = line[i - 1][2] + step / 20 * (line[i][2] - line[i - 1][2])
            lu.assertFalse(x > left and x < right and y > top and y < bottom, "a line is under " .. text.text)
          end
        end
      end
      lu.assertTrue(right <= p.width + 2 and bottom <= p.height and left >= 0 and top >= 0)
    end
  end
  lu.assertEquals(found, 2)
end

function testTheLegendCoversNoData()
  local rng = venule.rng(5)
  for round = 1, 60 do
    local series = {}
    for k = 1, 2 do
      local n, x, y = rng:integer(2, 50), {}, {}
      for i = 1, n do x[i], y[i] = rng:uniform(0, 1), rng:uniform(0, 1) ^ rng:integer(1, 5) end
      if k == 1 then table.sort(x) end
      series[k] = one(x, y, {label = k == 1 and "first of both" or "second", line = k == 1, marks = k == 2 or round % 3 == 0})
    end
    assert_legend_is_clear(venule.plot {series = series}, {["first of both"] = true, second = true})
  end
end

function testLabelsStandAsTheyAre()
  local p = venule.plot {title = "a < b & c", x = {label = "λ (µm)"}, y = {label = "ΔP"}, series = {one({1}, {1}, {label = "só"})}}
  local found = {}
  for _, text in ipairs(texts_of(p)) do found[text.text] = text end
  lu.assertNotNil(found["a < b & c"])
  lu.assertNotNil(found["λ (µm)"])
  lu.assertTrue(found["ΔP"].turned)
  lu.assertFalse(found["λ (µm)"].turned)
  lu.assertNotNil(found["só"])
end

function testFilesAreTheSameTwice()
  local function draw() return venule.plot {title = "twice", series = {one({1, 2, 3}, {1, 3, 2}, {label = "a", deviation = 1})}} end
  for _, extension in ipairs {"png", "svg", "pdf", "eps"} do
    lu.assertTrue(saved(draw(), extension) == saved(draw(), extension), extension)
  end
  lu.assertStrContains(saved(draw(), "eps"), "%%BoundingBox: 0 0 480 315\n")
end

function testColumnsOfANetworkArePlotted()
  local net = venule.network {dim = 2}
  local node = net:root(0, 0)
  for i = 1, 5 do node = net:add(node, i, i * i) end
  lu.assertEquals(#drawn_in(venule.plot {series = {one(net.x, net.y)}}, RED), 6)
end

function testWrongSeries()
  fails(function() venule.plot {} end,
    "plot: `series` is missing: a list of what is drawn: {x=, y=, deviation=, below=, band=, label=, color=, marks=, line=}")
  fails(function() venule.plot {series = {{x = {1, 2}, y = {1}}}} end, "plot.series[1]: x has 2 numbers and y 1; give as many")
  fails(function() venule.plot {series = {{x = {1, 2}, y = {1, 2}, deviation = {1}}}} end,
    "plot.series[1]: x has 2 numbers and deviation 1; give as many")
  fails(function() venule.plot {series = {{x = {1, "2"}, y = {1, 2}}}} end, "plot.series[1].x[2]: a number expected, got string")
  fails(function() venule.plot {series = {{x = 1, y = 2}}} end, "plot.series[1].x: a list of numbers expected, got number")
  fails(function() venule.plot {series = {{x = {1}, y = {2}, deviation = -1}}} end, "plot.series[1].deviation[1] = -1 must be at least 0")
  fails(function() venule.plot {series = {{x = {1}, y = {2}, deviation = 1, below = {-2}}}} end, "plot.series[1].below[1] = -2 must be at least 0")
  fails(function() venule.plot {series = {{x = {1}, y = {2}, below = 1}}} end, "plot.series[1].below needs deviation, those above")
  fails(function() venule.plot {series = {{x = {1}, y = {1e200}}}} end, "plot.series[1].y[1] = 1e+200 is beyond 1e150: use another unit")
  fails(function() venule.plot {series = {{x = {1}, y = {1}, colour = "red"}}} end,
    'plot.series[1]: unknown field "colour", did you mean "color"?')
  fails(function() venule.plot {series = {}, x = {min = 3, max = 3}} end, "plot.x.min = 3 must be below plot.x.max = 3")
  fails(function() venule.plot {series = {}, y = {lgo = true}} end, 'plot.y: unknown field "lgo", did you mean "log"?')
  fails(function() venule.plot {series = {}, width = 10} end,
    "plot.width = 10 must be from 100 to 32767 pixels: of the whole picture; 96 pixels are an inch on paper")
end

function testNoRoomForData()
  fails(function() venule.plot {series = {}, width = 100, text_size = 40} end,
    "plot: 100 x 420 pixels leave no room for data beside the text; give a larger width or height")
  fails(function() venule.plot {series = {{x = {1, 2, 1, 2}, y = {1, 2, 2, 1}, label = ("long "):rep(40)}}} end,
    "plot: 640 x 420 pixels leave no room for data beside the text; give a larger width or height")
end
