-- Figures of numbers: lines, points, deviations, on plain or logarithmic axes. A plot is a canvas like any other: one pixel is
-- one unit, (0, 0) its lower left corner.
local venule = ...

local options = require "venule.options"

local plot_rows = {
  {"width", 640, min = 100, max = 32767, unit = "pixels", doc = "of the whole picture; 96 pixels are an inch on paper"},
  {"height", 420, min = 100, max = 32767, unit = "pixels", doc = "of the whole picture"},
  {"title", nil, type = "string", doc = "above the plot"},
  {"x", nil, type = "table", doc = "the axis to the right: {label=, log=, min=, max=}"},
  {"y", nil, type = "table", doc = "the axis upwards: {label=, log=, min=, max=}"},
  {"series", nil, type = "table", required = true,
    doc = "a list of what is drawn: {x=, y=, deviation=, below=, band=, label=, color=, marks=, line=}"},
  {"background", "#ffffff", type = "string", doc = "a colour, or \"none\""},
  {"text_size", 13, min = 4, max = 200, unit = "pixels", doc = "of the numbers at the axes; labels are as large"},
}

local axis_rows = {
  {"label", nil, type = "string", doc = "what it measures, and the unit"},
  {"log", false, type = "boolean", doc = "logarithmic: for values above 0"},
  {"min", nil, type = "number", doc = "where it begins; left out: so that all is seen"},
  {"max", nil, type = "number", doc = "where it ends; left out: so that all is seen"},
}

local series_rows = {
  {"x", nil, type = "any", required = true, doc = "a list of numbers; a point that has one that is not finite is left out, and breaks the line"},
  {"y", nil, type = "any", required = true, doc = "a list of as many numbers"},
  {"deviation", nil, type = "any", doc = "a list of as many, or one number: y is drawn with so much above and below it"},
  {"below", nil, type = "any", doc = "the deviations below, where these are not those above"},
  {"band", false, type = "boolean", doc = "deviations as a band instead of bars"},
  {"label", nil, type = "string", doc = "what it is, in the legend"},
  {"color", nil, type = "string", doc = "left out: one that the others have not"},
  {"marks", nil, type = "boolean", doc = "a dot at each point; left out: where there are 60 or fewer"},
  {"line", true, type = "boolean", doc = "a line from point to point"},
}

-- Apart for most eyes, in print too, and none of them loud.
local PALETTE = {"#2f5d8a", "#c8553d", "#4f8a5b", "#8a5a9e", "#c9972b", "#5b6770", "#3b9ab2", "#a3485f"}
local INK, FAINT = "#333333", "#e4e4e4"
local MANY = 60 -- points stand too close for marks

-- ---- What is given ----

local function is_finite(value) return value == value and value ~= math.huge and value ~= -math.huge end

local function check_list(name, list, level)
  if type(list) ~= "table" and type(list) ~= "userdata" then
    error(("%s: a list of numbers expected, got %s"):format(name, type(list)), level + 1)
  end
  for i = 1, #list do
    if type(list[i]) ~= "number" then
      error(("%s[%d]: a number expected, got %s"):format(name, i, type(list[i])), level + 1)
    end
    if is_finite(list[i]) and math.abs(list[i]) > 1e150 then
      error(("%s[%d] = %g is beyond 1e150: use another unit"):format(name, i, list[i]), level + 1)
    end
  end
end

local function check_as_many(name, what, list, count, level)
  if #list ~= count then
    error(("%s: x has %d numbers and %s %d; give as many"):format(name, count, what, #list), level + 1)
  end
end

local function check_log(name, axis, list, level)
  if not axis.log then return end
  for i = 1, #list do
    if list[i] <= 0 then
      error(("%s[%d] = %g has no place on a logarithmic axis: give values above 0, and NaN for what is missing"):format(
        name, i, list[i]), level + 1)
    end
  end
end

-- The deviations as a list, NaN where there is none.
local function read_deviation(name, given, count, level)
  local list = {}
  if type(given) == "number" then
    for i = 1, count do list[i] = given end
  elseif given ~= nil then
    check_list(name, given, level + 1)
    for i = 1, #given do list[i] = given[i] end
  else
    return nil
  end
  for i, value in ipairs(list) do
    if value < 0 then error(("%s[%d] = %g must be at least 0"):format(name, i, value), level + 1) end
  end
  return list
end

local function read_series(name, given, axes, index, level)
  local s = options.read(name, series_rows, given, level + 1)
  check_list(name .. ".x", s.x, level + 1)
  check_list(name .. ".y", s.y, level + 1)
  check_as_many(name, "y", s.y, #s.x, level + 1)
  if s.below and not s.deviation then error(name .. ".below needs deviation, those above", level + 1) end
  for _, key in ipairs {"deviation", "below"} do
    s[key] = read_deviation(name .. "." .. key, s[key], #s.x, level + 1)
    if s[key] then check_as_many(name, key, s[key], #s.x, level + 1) end
  end
  check_log(name .. ".x", axes.x, s.x, level + 1)
  check_log(name .. ".y", axes.y, s.y, level + 1)
  s.color = s.color or PALETTE[(index - 1) % #PALETTE + 1]
  if s.marks == nil then s.marks = #s.x <= MANY end
  return s
end

local function read_axis(name, given, level)
  local axis = options.read(name, axis_rows, given or {}, level + 1)
  for _, key in ipairs {"min", "max"} do
    local value = axis[key]
    if value and not (math.abs(value) <= 1e150) then
      error(("%s.%s = %g must be within 1e150"):format(name, key, value), level + 1)
    end
    if value and axis.log and value <= 0 then
      error(("%s.%s = %g must be above 0 on a logarithmic axis"):format(name, key, value), level + 1)
    end
  end
  if axis.min and axis.max and axis.min >= axis.max then
    error(("%s.min = %g must be below %s.max = %g"):format(name, axis.min, name, axis.max), level + 1)
  end
  return axis
end

local function read(given, level)
  local p = options.read("plot", plot_rows, given, level + 1)
  local axes = {x = read_axis("plot.x", p.x, level + 1), y = read_axis("plot.y", p.y, level + 1)}
  local series = {}
  for i = 1, #p.series do series[i] = read_series(("plot.series[%d]"):format(i), p.series[i], axes, i, level + 1) end
  p.x, p.y, p.series = axes.x, axes.y, series
  return p
end

-- ---- Points, ranges and ticks. On a logarithmic axis everything is in decades. ----

-- The points of a series that are seen at all, in runs without a gap: {x, y, low, high}.
local function runs_of(s, p)
  local runs, run = {}, nil
  local function on(axis, value) return axis.log and math.log(value, 10) or value end
  for i = 1, #s.x do
    local x, y, d = s.x[i], s.y[i], s.deviation and s.deviation[i]
    if is_finite(x) and is_finite(y) then
      local point = {x = on(p.x, x), y = on(p.y, y)}
      local below = s.below and s.below[i] or d
      if d and is_finite(d) and is_finite(below) and d + below > 0 then
        local low = y - below
        point.low, point.high = (not p.y.log or low > 0) and on(p.y, low) or -math.huge, on(p.y, y + d)
      end
      if not run then
        run = {}
        runs[#runs + 1] = run
      end
      run[#run + 1] = point
    else
      run = nil
    end
  end
  return runs
end

local function each_point(p, visit)
  for _, s in ipairs(p.series) do
    for _, run in ipairs(s.runs) do
      for _, point in ipairs(run) do visit(point, s) end
    end
  end
end

local function data_range(p, key)
  local low, high = math.huge, -math.huge
  each_point(p, function(point)
    low, high = math.min(low, point[key]), math.max(high, point[key])
    if key == "y" and point.low then
      if point.low > -math.huge then low = math.min(low, point.low) end
      high = math.max(high, point.high)
    end
  end)
  if low > high then return 0, 1 end
  return low, high
end

-- A range that is nothing but one value, or a number's last digits, has room about it.
local function widened(low, high, log)
  if high - low > 1e-12 * math.max(math.abs(low), math.abs(high)) then return low, high end
  local room = log and 0.5 or (low ~= 0 and math.abs(low) / 2 or 1)
  return low - room, high + room
end

-- Where the axis begins and ends: the data with a little room. What is measured from nearly 0 begins there.
local function set_range(p, key)
  local axis = p[key]
  local min = axis.min and (axis.log and math.log(axis.min, 10) or axis.min)
  local max = axis.max and (axis.log and math.log(axis.max, 10) or axis.max)
  local low, high = data_range(p, key)
  low, high = widened(math.min(min or low, max or low), math.max(max or high, min or high), axis.log)
  local room = (high - low) * 0.04
  local from_zero = not axis.log and low >= 0 and low < 0.3 * high
  axis.low = min or (from_zero and 0 or low - room)
  axis.high = max or high + room
end

local function nice_step(range, most)
  local rough = range / math.max(most, 1)
  local power = 10 ^ math.floor(math.log(rough, 10))
  for _, factor in ipairs {1, 2, 5} do
    if factor * power >= rough * (1 - 1e-9) then return factor * power end
  end
  return 10 * power
end

local SUPERSCRIPTS = {["0"] = "⁰", ["1"] = "¹", ["2"] = "²", ["3"] = "³", ["4"] = "⁴", ["5"] = "⁵", ["6"] = "⁶", ["7"] = "⁷",
  ["8"] = "⁸", ["9"] = "⁹", ["-"] = "⁻"}

local function power_of_ten(exponent) return "10" .. ("%d"):format(exponent):gsub(".", SUPERSCRIPTS) end

local function with_minus(text) return (text:gsub("^-", "−")) end

-- A number as people write it; `step` says how exactly.
local function in_digits(value, step, largest)
  if math.abs(value) < step * 1e-6 then return "0" end
  if largest >= 1e6 or step < 1e-4 then
    local exponent = math.floor(math.log(largest, 10) + 1e-9)
    local digits = math.max(0, exponent - math.floor(math.log(step, 10) + 1e-9))
    return with_minus(("%." .. digits .. "f"):format(value / 10.0 ^ exponent)) .. "·" .. power_of_ten(exponent)
  end
  return with_minus(("%." .. math.max(0, -math.floor(math.log(step, 10) + 1e-9)) .. "f"):format(value))
end

local function plain_ticks(axis, most)
  local ticks, step = {}, nice_step(axis.high - axis.low, most)
  local largest = math.max(math.abs(axis.low), math.abs(axis.high))
  if axis.high - axis.low <= 1e-12 * largest then return ticks end -- counting would not get from one to the next
  for i = math.ceil(axis.low / step - 1e-6), math.floor(axis.high / step + 1e-6) do
    ticks[#ticks + 1] = {at = i * step, label = in_digits(i * step, step, largest)}
  end
  return ticks
end

local function decade_ticks(axis, most)
  local ticks = {}
  local first, last = math.ceil(axis.low - 1e-9), math.floor(axis.high + 1e-9)
  local every = math.max(1, math.ceil((last - first + 1) / most))
  local short = first >= -3 and last <= 3
  for decade = first - 1, last do
    if decade >= first and (decade - first) % every == 0 then
      ticks[#ticks + 1] = {at = decade, label = short and ("%.15g"):format(10.0 ^ decade) or power_of_ten(decade)}
    end
    for digit = 2, every == 1 and 9 or 0 do
      local at = decade + math.log(digit, 10)
      if at >= axis.low and at <= axis.high then ticks[#ticks + 1] = {at = at, minor = true} end
    end
  end
  return ticks, last - first + 1
end

-- Of a range that holds hardly a power of ten: 1, 2 and 5 of each decade, or what a plain axis would have.
local function short_ticks(axis, most)
  local ticks = {}
  for decade = math.floor(axis.low), math.floor(axis.high) do
    for _, digit in ipairs {1, 2, 5} do
      local at = decade + math.log(digit, 10)
      if at >= axis.low and at <= axis.high then
        ticks[#ticks + 1] = {at = at, label = ("%.15g"):format(digit * 10.0 ^ decade)}
      end
    end
  end
  if #ticks >= 2 then return ticks end
  local plain = plain_ticks({low = 10 ^ axis.low, high = 10 ^ axis.high}, most)
  for i, tick in ipairs(plain) do plain[i] = {at = math.log(tick.at, 10), label = tick.label} end
  return plain
end

local function ticks_of(axis, pixels, spacing)
  local most = math.max(2, pixels // spacing)
  if not axis.log then return plain_ticks(axis, most) end
  local ticks, decades = decade_ticks(axis, most)
  return decades >= 2 and ticks or short_ticks(axis, most)
end

-- ---- Where things stand ----

local function widest_label(ticks, size)
  local widest = 0
  for _, tick in ipairs(ticks) do
    if tick.label then widest = math.max(widest, venule.text_width(tick.label, size)) end
  end
  return widest
end

-- The frame of the data, in pixels, with `aside` kept free at its right. The numbers at an axis need room, and how many fit
-- depends on the room: heights first.
local function lay_out(p, aside)
  local size = p.text_size
  local f = {bottom = 1.9 * size + (p.x.label and 1.6 * size or 0) + 6, top = p.height - (p.title and 2.4 * size or 0.9 * size)}
  p.y.ticks = ticks_of(p.y, f.top - f.bottom, 3.4 * size)
  f.left = widest_label(p.y.ticks, size) + (p.y.label and 1.9 * size or 0) + 16
  f.right = p.width - 1.2 * size - aside
  p.x.ticks = ticks_of(p.x, f.right - f.left, 6 * size)
  p.frame = f
end

local function place(p, x, y)
  local f = p.frame
  return f.left + (x - p.x.low) / (p.x.high - p.x.low) * (f.right - f.left),
    f.bottom + (y - p.y.low) / (p.y.high - p.y.low) * (f.top - f.bottom)
end

local function is_inside(p, x, y)
  return x >= p.x.low and x <= p.x.high and y >= p.y.low and y <= p.y.high
end

local function clamp(value, low, high) return math.min(math.max(value, low), high) end

-- The part of a line that is within the frame (Liang and Barsky), or nil. Ends that are inside stay as they are, bit by bit.
local function clip(f, a, b)
  local from, to = 0, 1
  local dx, dy = b[1] - a[1], b[2] - a[2]
  for _, side in ipairs {{-dx, a[1] - f.left}, {dx, f.right - a[1]}, {-dy, a[2] - f.bottom}, {dy, f.top - a[2]}} do
    local d, room = side[1], side[2]
    if d == 0 and room < 0 then return nil end
    if d < 0 then from = math.max(from, room / d) elseif d > 0 then to = math.min(to, room / d) end
  end
  if from > to then return nil end
  return from == 0 and a or {a[1] + from * dx, a[2] + from * dy}, to == 1 and b or {a[1] + to * dx, a[2] + to * dy}
end

-- The lines of a series within the frame, as polylines.
local function lines_of(p, s)
  local lines, line = {}, nil
  for _, run in ipairs(s.runs) do
    line = nil
    for i = 2, #run do
      local a, b = clip(p.frame, {place(p, run[i - 1].x, run[i - 1].y)}, {place(p, run[i].x, run[i].y)})
      if a and line and line[#line][1] == a[1] and line[#line][2] == a[2] then
        line[#line + 1] = b
      elseif a then
        line = {a, b}
        lines[#lines + 1] = line
      end
    end
  end
  return lines
end

-- Upright lines where a series deviates, cut at the frame.
local function bars_of(p, s)
  local bars = {}
  for _, run in ipairs(s.runs) do
    for _, point in ipairs(run) do
      if point.low and point.x >= p.x.low and point.x <= p.x.high and point.high >= p.y.low and point.low <= p.y.high then
        local x, low = place(p, point.x, clamp(point.low, p.y.low, p.y.high))
        local _, high = place(p, point.x, clamp(point.high, p.y.low, p.y.high))
        bars[#bars + 1] = {x = x, low = low, high = high, below = point.low < p.y.low, above = point.high > p.y.high}
      end
    end
  end
  return bars
end

-- Neighbours that deviate, run by run; not cut at the frame.
local function bands_of(p, s)
  local bands = {}
  for _, run in ipairs(s.runs) do
    local band = {}
    for _, point in ipairs(run) do
      local range = p.y.high - p.y.low -- what is endlessly low is below the frame
      local x, low = place(p, point.x, math.max(point.low or point.y, p.y.low - range))
      local _, high = place(p, point.x, point.high or point.y)
      band[#band + 1] = {x = x, low = low, high = high}
    end
    if #band >= 2 then bands[#bands + 1] = band end
  end
  return bands
end

local function marks_of(p, s)
  local marks = {}
  for _, run in ipairs(s.runs) do
    for _, point in ipairs(run) do
      if is_inside(p, point.x, point.y) then marks[#marks + 1] = {place(p, point.x, point.y)} end
    end
  end
  return marks
end

-- ---- The legend ----

local SAMPLE = 24 -- length of the line beside a label, pixels

local function legend_of(p)
  local legend = {entries = {}, width = 0, size = p.text_size}
  for _, s in ipairs(p.series) do
    if s.label then
      legend.entries[#legend.entries + 1] = s
      legend.width = math.max(legend.width, SAMPLE + 8 + venule.text_width(s.label, p.text_size))
    end
  end
  legend.height = #legend.entries * 1.5 * p.text_size
  return #legend.entries > 0 and legend or nil
end

local function crosses(box, a, b)
  return clip({left = box[1], bottom = box[2], right = box[3], top = box[4]}, a, b) ~= nil
end

-- A little more than whether they meet: the band counts as high as it is at the higher of two neighbours.
local function meets_band(band, box)
  for i = 2, #band do
    local a, b = band[i - 1], band[i]
    if math.max(a.x, b.x) > box[1] and math.min(a.x, b.x) < box[3] and math.max(a.high, b.high) > box[2] and
      math.min(a.low, b.low) < box[4] then return true end
  end
  return false
end

local function meets_lines(p, s, box)
  for _, line in ipairs(s.line and lines_of(p, s) or {}) do
    for i = 2, #line do
      if crosses(box, line[i - 1], line[i]) then return true end
    end
  end
  return false
end

local function meets_deviations(p, s, box)
  for _, band in ipairs(s.band and bands_of(p, s) or {}) do
    if meets_band(band, box) then return true end
  end
  for _, bar in ipairs(not s.band and bars_of(p, s) or {}) do
    if crosses(box, {bar.x, bar.low}, {bar.x, bar.high}) then return true end
  end
  return false
end

local function meets_series(p, s, box)
  for _, mark in ipairs(s.marks and marks_of(p, s) or {}) do
    if crosses(box, mark, mark) then return true end
  end
  return meets_lines(p, s, box) or s.deviation and meets_deviations(p, s, box)
end

local function is_free(p, box)
  for _, s in ipairs(p.series) do
    if meets_series(p, s, box) then return false end
  end
  return true
end

-- Into a corner of the frame where nothing is, or else beside it.
local function place_legend(p, legend)
  local f, room = p.frame, 10
  for _, corner in ipairs {{1, 1}, {0, 1}, {1, 0}, {0, 0}, {0.5, 1}, {0.5, 0}, {1, 0.5}, {0, 0.5}} do
    local x = f.left + room + corner[1] * (f.right - f.left - 2 * room - legend.width)
    local y = f.bottom + room + corner[2] * (f.top - f.bottom - 2 * room - legend.height)
    if x >= f.left and y >= f.bottom and is_free(p, {x - 6, y - 6, x + legend.width + 6, y + legend.height + 6}) then
      legend.x, legend.y = x, y
      return
    end
  end
  lay_out(p, legend.width + 18)
  legend.x, legend.y = p.frame.right + 18, p.frame.top - legend.height
end

-- ---- Drawing ----

local function draw_text(c, p, text, x, y, anchor, angle, scale)
  c:text(text, {at = {x, y}, size = p.text_size * (scale or 1), color = INK, anchor = anchor, angle = angle})
end

local function draw_line(c, x1, y1, x2, y2, color, width)
  c:line({{x1, y1}, {x2, y2}}, {color = color, width = width or 1})
end

local function draw_ticks(c, p)
  local f, size = p.frame, p.text_size
  for _, tick in ipairs(p.x.ticks) do
    local x = place(p, tick.at, p.y.low)
    if tick.label then draw_line(c, x, f.bottom, x, f.top, FAINT) end
    draw_line(c, x, f.bottom, x, f.bottom - (tick.minor and 3 or 5), INK, tick.minor and 0.6 or 1)
    if tick.label then draw_text(c, p, tick.label, x, f.bottom - 7 - 0.95 * size, "middle") end
  end
  for _, tick in ipairs(p.y.ticks) do
    local _, y = place(p, p.x.low, tick.at)
    if tick.label then draw_line(c, f.left, y, f.right, y, FAINT) end
    draw_line(c, f.left, y, f.left - (tick.minor and 3 or 5), y, INK, tick.minor and 0.6 or 1)
    if tick.label then draw_text(c, p, tick.label, f.left - 9, y - 0.36 * size, "end") end
  end
end

local function draw_axes(c, p)
  local f, size = p.frame, p.text_size
  c:line({{f.left, f.top}, {f.left, f.bottom}, {f.right, f.bottom}}, {color = INK, width = 1})
  local middle = 0.5 * (f.left + f.right)
  if p.x.label then draw_text(c, p, p.x.label, middle, 0.55 * size, "middle") end
  if p.y.label then draw_text(c, p, p.y.label, 1.3 * size, 0.5 * (f.bottom + f.top), "middle", 90) end
  if p.title then draw_text(c, p, p.title, middle, p.height - 1.55 * size, "middle", 0, 1.15) end
end

-- What of a ring is on one side of an upright or level line (Sutherland and Hodgman).
local function cut_ring(ring, axis, at, keep)
  local cut = {}
  for i, b in ipairs(ring) do
    local a = ring[i == 1 and #ring or i - 1]
    local inside_a, inside_b = keep * (a[axis] - at) >= 0, keep * (b[axis] - at) >= 0
    if inside_a ~= inside_b then
      local share = (at - a[axis]) / (b[axis] - a[axis])
      local other = a[3 - axis] + share * (b[3 - axis] - a[3 - axis])
      cut[#cut + 1] = axis == 1 and {at, other} or {other, at}
    end
    if inside_b then cut[#cut + 1] = b end
  end
  return cut
end

local function ring_of(band)
  local ring = {}
  for _, bar in ipairs(band) do ring[#ring + 1] = {bar.x, bar.high} end
  for i = #band, 1, -1 do ring[#ring + 1] = {band[i].x, band[i].low} end
  return ring
end

local function draw_bands(c, p, s)
  local f = p.frame
  for _, band in ipairs(bands_of(p, s)) do
    local ring = cut_ring(cut_ring(ring_of(band), 1, f.left, 1), 1, f.right, -1)
    ring = cut_ring(cut_ring(ring, 2, f.bottom, 1), 2, f.top, -1)
    if #ring >= 3 then c:line(ring, {color = "none", fill = s.color, opacity = 0.2}) end
  end
end

local function draw_bars(c, p, s)
  for _, bar in ipairs(bars_of(p, s)) do
    draw_line(c, bar.x, bar.low, bar.x, bar.high, s.color)
    if not bar.below then draw_line(c, bar.x - 3, bar.low, bar.x + 3, bar.low, s.color) end
    if not bar.above then draw_line(c, bar.x - 3, bar.high, bar.x + 3, bar.high, s.color) end
  end
end

local function draw_marks(c, p, s, marks)
  if #marks == 0 then return end
  if s.line and p.background ~= "none" then c:dots(marks, {radius = 4.2, color = p.background}) end
  c:dots(marks, {radius = 3, color = s.color})
end

local function draw_series(c, p, s)
  if s.deviation and not s.band then draw_bars(c, p, s) end
  for _, line in ipairs(s.line and lines_of(p, s) or {}) do c:line(line, {color = s.color, width = 1.6}) end
  if s.marks then draw_marks(c, p, s, marks_of(p, s)) end
end

local function draw_legend(c, p, legend)
  for i, s in ipairs(legend.entries) do
    local y = legend.y + legend.height - (i - 0.5) * 1.5 * legend.size
    local middle = legend.x + SAMPLE / 2
    if s.band and s.deviation then
      local h = 0.45 * legend.size
      c:line({{legend.x, y - h}, {legend.x + SAMPLE, y - h}, {legend.x + SAMPLE, y + h}, {legend.x, y + h}},
        {color = "none", fill = s.color, opacity = 0.2})
    end
    if s.line then draw_line(c, legend.x, y, legend.x + SAMPLE, y, s.color, 1.6) end
    if s.marks then draw_marks(c, p, s, {{middle, y}}) end
    draw_text(c, p, s.label, legend.x + SAMPLE + 8, y - 0.36 * legend.size)
  end
end

local function draw(p, legend)
  local c = venule.canvas {width = p.width, height = p.height, background = p.background}
  draw_ticks(c, p)
  draw_axes(c, p)
  for _, s in ipairs(p.series) do
    if s.deviation and s.band then draw_bands(c, p, s) end
  end
  for _, s in ipairs(p.series) do draw_series(c, p, s) end
  if legend then draw_legend(c, p, legend) end
  return c
end

--- A plot as a canvas.
local function plot(given)
  local p = read(given, 2)
  for _, s in ipairs(p.series) do s.runs = runs_of(s, p) end
  set_range(p, "x")
  set_range(p, "y")
  lay_out(p, 0)
  local legend = legend_of(p)
  if legend then place_legend(p, legend) end
  if p.frame.right - p.frame.left < 20 or p.frame.top - p.frame.bottom < 20 then
    error(("plot: %d x %d pixels leave no room for data beside the text; give a larger width or height"):format(
      p.width, p.height), 2)
  end
  return draw(p, legend)
end

return {plot = plot, plot_rows = plot_rows, plot_axis_rows = axis_rows, plot_series_rows = series_rows}
