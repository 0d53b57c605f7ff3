-- What the strict readers say: of every table of options, every message, whole, on one line, with the script's line.
local venule = require "venule"
local lu = require "luaunit"

local domain, growth = venule.domain, venule.growth
local INF = math.huge
local NAN = 0 / 0
if ("%g"):format(NAN):find "-" then NAN = -NAN end -- which sign 0 / 0 has is the machine's affair

-- `f` stands on one line, which its message must begin with.
local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

local function rng() return venule.rng(1) end
local function disk() return domain.disk {} end
local function net() return venule.network {} end
local function canvas() return venule.canvas {width = 100, height = 100} end

local function influence()
  local n, a = net(), venule.attractors {}
  n:root(0, 0)
  a:add(1, 0)
  return a:influence(n), n, a
end

-- Every table of options: how to hand one over, what must be in it, and its fields as the manual has them.
local tables = {
  disk = {
    call = function(o) domain.disk(o) end, optional = true,
    center = {kind = "point"},
    radius = {kind = "number", above = 0, max = 1e150, unit = "length", doc = "from the middle to the border"},
  },
  sphere = {
    call = function(o) domain.sphere(o) end, optional = true,
    center = {kind = "point"},
    radius = {kind = "number", above = 0, max = 1e150, unit = "length", doc = "from the middle to the border"},
  },
  box = {
    call = function(o) domain.box(o) end,
    given = {min = {0, 0}, max = {1, 1}},
    min = {kind = "point", required = true, doc = "its corner of least coordinates"},
    max = {kind = "point", required = true,
      doc = "the opposite corner; two coordinates make a flat box, three a solid one"},
  },
  profile = {
    call = function(o) domain.profile(o) end,
    given = {length = 1, samples = 9, half_width = function(t) return t * (1 - t) end},
    length = {kind = "number", above = 0, max = 1e150, unit = "length", doc = "from the base at (0, 0) to the tip at (0, length)"},
    samples = {kind = "integer", min = 3, max = 1000000, unit = "points",
      doc = "how many points of a half_width function are taken (a table is taken as it is)"},
    half_width = {kind = "mixed", required = true, doc = "half the blade's width along its midrib; 0 or more"},
  },
  svg = {
    call = function(o) domain.svg("no-such.svg", o) end, optional = true,
    id = {kind = "text", doc = "id of the shape, or of a group of shapes, that is the outline; otherwise pick decides"},
    pick = {kind = "choice", choices = "largest|all",
      doc = "without an id: the filled shape of the largest area, or everything filled, united"},
    tolerance = {kind = "number", min = 0, max = 1e300, unit = "length",
      doc = "curves become polylines that are within this of them; 0 for 1e-4 of the shape's size"},
    ["repair"] = {kind = "bool", doc = "accept outlines that cross themselves, and fill them as a painter would"},
  },
  sample = {
    call = function(o) disk():sample(3, o) end,
    given = {rng = rng()},
    spacing = {kind = "number", above = 0, max = 1e150, unit = "length",
      doc = "a point this close to an earlier one is refused; left out: none is"},
    rng = {kind = "rng", required = true, doc = "the random numbers: venule.rng(seed)"},
  },
  none = {
    call = function(o) growth.none(o) end,
    given = {domain = disk()},
    domain = {kind = "domain", required = true, doc = "the shape, which stays as it is"},
  },
  marginal = {
    call = function(o) growth.marginal(o) end,
    given = {domain = disk()},
    domain = {kind = "domain", required = true, doc = "the shape of the blade"},
    origin = {kind = "point"},
    from = {kind = "number", above = 0, max = 1e150, unit = "length", doc = "the blade's length at first; left out: a twentieth of `to`"},
    to = {kind = "number", above = 0, max = 1e150, unit = "length",
      doc = "its length when grown; left out: the domain's own length, its extent along y"},
    step = {kind = "number", above = 0, max = 1e150, unit = "length",
      doc = "the length that each step adds; left out: a hundredth of to - from"},
  },
  network = {
    call = function(o) venule.network(o) end, optional = true,
    dim = {kind = "integer", min = 2, max = 3, doc = "dimensions: 2 or 3"},
    max_nodes = {kind = "integer", min = 1, max = 2147483647, unit = "nodes",
      doc = "a network that would grow beyond it fails; guards against a script that runs away"},
    unit = {kind = "text", doc = "the script's length unit (\"mm\"), carried into files"},
  },
  murray = {
    call = function(o) net():murray(o) end, optional = true,
    exponent = {kind = "number", above = 0, max = 100, doc = "n in r_parent^n = Σ r_child^n: 3 by Murray, 2 in most of Runions' leaves"},
    tip_radius = {kind = "number", above = 0, max = 1e300, unit = "length", doc = "radius of the edges that end in a tip"},
    veinlets = {kind = "number", min = 0, max = 1e9, unit = "tips",
      doc = "what each node of a primary or secondary vein takes up besides its children, for veinlets that are not modeled"},
  },
  measure = {
    call = function(o) net():measure(o) end, optional = true,
    domain = {kind = "domain", doc = "the blade, whose area counts; left out: the convex hull of the nodes"},
    resolution = {kind = "number", above = 0, max = 1e300, unit = "length",
      doc = "spacing of the points of the map of distances to veins; left out: 40,000 in the area"},
  },
  orders = {
    call = function(o) net():orders("hickey", o) end, optional = true,
    ratio = {kind = "number", above = 0, max = 1,
      doc = "hickey: a lateral this many times as thick as the thickest child has its order too; left out: none has"},
  },
  extend = {
    call = function(o) local f, n = influence() n:extend(f, o) end,
    given = {length = 1},
    length = {kind = "number", required = true, above = 0, max = 1e150, unit = "length", doc = "D, the length of a new vein segment"},
    domain = {kind = "domain", doc = "an edge that would leave it is not made; its attractor turns to the nearest node that sees it"},
    meet = {kind = "choice", choices = "cross|join|stop",
      doc = "what a vein does that would cross another one: go on across it, as in the papers, end there, joined to it, or not grow (both in 2D); what drew that vein alone is then given up"},
  },
  attractors = {
    call = function(o) venule.attractors(o) end, optional = true,
    dim = {kind = "integer", min = 2, max = 3, doc = "dimensions: 2 or 3"},
    seed = {kind = "integer", min = -9e15, max = 9e15, doc = "decides which of equally near nodes an attractor influences"},
  },
  throw = {
    call = function(o) venule.attractors {}:throw(o) end,
    given = {domain = disk(), rng = rng(), count = 1},
    domain = {kind = "domain", required = true, doc = "where the darts fall"},
    count = {kind = "integer", min = 0, max = 2147483647, unit = "darts", doc = "how many darts; or give `density`"},
    density = {kind = "number", min = 0, max = 1e300, unit = "darts/length²",
      doc = "darts per area (volume) of the domain; a fraction of a dart is carried to the next call"},
    spacing = {kind = "number", above = 0, max = 1e150, unit = "length",
      doc = "birth distance b_s: a dart this close to an attractor is refused; left out: none is"},
    clearance = {kind = "number", above = 0, max = 1e150, unit = "length",
      doc = "birth distance b_v: a dart this close to a node of `network` is refused; left out: none is"},
    network = {kind = "network", doc = "what `clearance` keeps clear of"},
    rng = {kind = "rng", required = true, doc = "the random numbers: venule.rng(seed)"},
  },
  influence = {
    call = function(o) local _, n, a = influence() a:influence(n, o) end, optional = true,
    mode = {kind = "choice", choices = "nearest|relative|urquhart",
      doc = "which nodes an attractor influences: the nearest one (open venation, Runions §3), its relative neighbors (closed venation, §4), or the Urquhart approximation of these (§5.2)"},
    within = {kind = "number", above = 0, max = 1e300, unit = "length",
      doc = "attraction distance: nodes farther away are not influenced; left out: any distance"},
  },
  consume = {
    call = function(o) local _, n, a = influence() a:consume(n, o) end,
    given = {distance = 1},
    distance = {kind = "number", required = true, above = 0, max = 1e300, unit = "length",
      doc = "kill distance: an attractor that a node is closer to is consumed"},
    mode = {kind = "choice", choices = "any|all|tagged",
      doc = "which nodes must be that close: any one (open venation, Runions §3.3), all that it influences (Webb), or all whose veins it influenced when the first one came (closed venation, §4)"},
    into = {kind = "attractors", doc = "a set that the consumed ones are added to"},
  },
  canvas = {
    call = function(o) venule.canvas(o) end, optional = true,
    width = {kind = "number", max = 32767, unit = "pixels", doc = "width of the picture; left out: from the height and the view's proportions, or 800"},
    height = {kind = "number", max = 32767, unit = "pixels", doc = "height of the picture; left out: from the width and the view's proportions, or 800"},
    margin = {kind = "number", min = 0, max = 16383, unit = "pixels", doc = "kept free around the view"},
    background = {kind = "text", doc = "a colour, or \"none\""},
    unit = {kind = "text", doc = "length unit of the view: \"mm\", \"cm\", \"m\", \"um\", \"in\" or \"pt\"; pages (SVG, PDF) " ..
      "are then at true scale; \"\": 96 pixels an inch"},
  },
  camera = {
    call = function(o) venule.canvas {camera = o, view = {min = {0, 0, 0}, max = {1, 1, 1}}} end, optional = true,
    from = {kind = "point"}, to = {kind = "point"}, up = {kind = "point"},
    fov = {kind = "number", min = 0, max = 150, unit = "degrees",
      doc = "angle that the canvas's shorter side shows, less its margins; 0: a parallel projection"},
    zoom = {kind = "number", above = 0, max = 1e6, doc = "enlarges the picture about its middle"},
    fog = {kind = "number", min = 0, max = 1, doc = "how much what is farthest in the view fades into the background"},
  },
  fill = {
    call = function(o) canvas():fill(disk(), o) end, optional = true,
    color = {kind = "text", doc = "colour of the inside, or \"none\""},
    opacity = {kind = "number", min = 0, max = 1, doc = "0 is invisible, 1 hides what is behind"},
    stroke = {kind = "text", doc = "colour of the outline, or \"none\""},
    line_width = {kind = "number", min = 0, max = 1e300, unit = "length", doc = "width of the outline; 0: one pixel"},
  },
  stroke = {
    call = function(o) canvas():stroke(net(), o) end, optional = true,
    color = {kind = "text", doc = "colour of the veins"},
    opacity = {kind = "number", min = 0, max = 1, doc = "0 is invisible, 1 hides what is behind; veins that cross do not darken each other"},
    min_width = {kind = "number", min = 0, max = 32767, unit = "pixels",
      doc = "no edge is drawn thinner than this, so that the finest veins do not vanish"},
    ramp = {kind = "text", doc = "colours between spaces, from that of the least number to that of the greatest"},
    hide_below = {kind = "number", min = 0, max = 32767, unit = "pixels",
      doc = "edges thinner than this are left out, so that a large network makes a small file; 0: none is"},
  },
  dots = {
    call = function(o) canvas():dots({{1, 1}}, o) end, optional = true,
    color = {kind = "text", doc = "colour of the dots"},
    opacity = {kind = "number", min = 0, max = 1, doc = "0 is invisible, 1 hides what is behind; dots that overlap do not darken each other"},
    radius = {kind = "number", min = 0, max = 1e300, unit = "length", doc = "of each dot; 0: two pixels"},
  },
  line = {
    call = function(o) canvas():line({{1, 1}, {2, 2}}, o) end, optional = true,
    color = {kind = "text", doc = "colour of the line, or \"none\""},
    opacity = {kind = "number", min = 0, max = 1, doc = "0 is invisible, 1 hides what is behind"},
    width = {kind = "number", above = 0, max = 32767, unit = "pixels", doc = "of the line"},
    fill = {kind = "text", doc = "colour of the inside of a line that is then closed, or \"none\""},
  },
  text = {
    call = function(o) canvas():text("a", o) end, optional = true,
    angle = {kind = "number", min = -360, max = 360, unit = "degrees", doc = "by which the line is turned, counterclockwise"},
    at = {kind = "point"},
    color = {kind = "text", doc = "colour of the letters"},
    size = {kind = "number", above = 0, max = 32767, unit = "pixels", doc = "height of the letters"},
    opacity = {kind = "number", min = 0, max = 1, doc = "0 is invisible, 1 hides what is behind"},
    anchor = {kind = "choice", choices = "start|middle|end", doc = "which part of the text is at `at`"},
  },
}

-- By name, so that a failure is always the same one.
local function each_table(visit)
  local names = {}
  for name in pairs(tables) do names[#names + 1] = name end
  table.sort(names)
  for _, name in ipairs(names) do visit(name, tables[name]) end
end

local function each_field(visit)
  each_table(function(name, t)
    local fields = {}
    for field, row in pairs(t) do
      if type(row) == "table" and row.kind then fields[#fields + 1] = field end
    end
    table.sort(fields)
    for _, field in ipairs(fields) do visit(name, t, field, t[field]) end
  end)
end

local function options_with(t, field, value)
  local o = {}
  for key, given in pairs(t.given or {}) do o[key] = given end
  if field ~= nil then o[field] = value end
  return o
end

-- The call with `field = value` must fail with the message and the line of the call.
local function refuses(t, field, value, message)
  local info = debug.getinfo(t.call, "S")
  local ok, err = pcall(t.call, options_with(t, field, value))
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

function testTheMessageThatTheDesignPromises()
  local auxin = venule.attractors {}
  fails(function() auxin:throw {domain = disk(), spcing = 1, count = 1, rng = rng()} end, 'throw: unknown field "spcing", did you mean "spacing"?')
end

function testGivenOptionsAreGood()
  each_table(function(name, t)
    if name ~= "svg" then t.call(options_with(t)) end
    if t.optional and name ~= "svg" then t.call(nil) end
  end)
end

function testUnknownFields()
  each_table(function(name, t) refuses(t, "qqqqqqqq", 1, ('%s: unknown field "qqqqqqqq"'):format(name)) end)
end

-- A letter too many at the end of each field, and two letters swapped.
function testSuggestions()
  each_field(function(name, t, field)
    if #field < 4 then return end
    refuses(t, field .. "s", 1, ('%s: unknown field "%ss", did you mean "%s"?'):format(name, field, field))
    local swapped = field:sub(2, 2) .. field:sub(1, 1) .. field:sub(3)
    refuses(t, swapped, 1, ('%s: unknown field "%s", did you mean "%s"?'):format(name, swapped, field))
  end)
end

function testOtherCaseIsAnotherName()
  fails(function() domain.disk {Radius = 1} end, 'disk: unknown field "Radius", did you mean "radius"?')
end

function testNumericKeys()
  each_table(function(name, t)
    refuses(t, 1, 1, ('%s: unknown field "1"'):format(name))
    refuses(t, 2.5, 1, ('%s: unknown field "2.5"'):format(name))
  end)
end

function testKeysThatAreNoNames()
  each_table(function(name, t) refuses(t, true, 1, ('%s: unknown field "true"'):format(name)) end)
end

function testNotATable()
  each_table(function(name, t)
    local info = debug.getinfo(t.call, "S")
    for value, kind in pairs {[7] = "number", ["7"] = "string", [true] = "boolean"} do
      local ok, err = pcall(t.call, value)
      lu.assertFalse(ok)
      lu.assertEquals(err, ("%s:%d: %s: a table of options {…} expected, got %s"):format(info.short_src, info.linedefined, name, kind))
    end
  end)
end

function testRequiredFields()
  each_field(function(name, t, field, row)
    if not row.required then return end
    local o = options_with(t)
    o[field] = nil
    local info = debug.getinfo(t.call, "S")
    local ok, err = pcall(t.call, o)
    lu.assertFalse(ok)
    lu.assertEquals(err, ("%s:%d: %s: `%s` is missing: %s"):format(info.short_src, info.linedefined, name, field, row.doc))
  end)
end

local words = {number = "number", integer = "number", text = "string", bool = "true or false"}

function testWrongTypes()
  each_field(function(name, t, field, row)
    local wanted = row.kind == "choice" and row.choices or words[row.kind]
    if not wanted then return end
    for _, value in ipairs {"1", 1, true, {}, print} do
      local own = (row.kind == "number" or row.kind == "integer") and "number" or row.kind == "bool" and "boolean" or "string"
      if type(value) ~= own then
        refuses(t, field, value, ("%s.%s: %s expected, got %s (%s)"):format(name, field, wanted, type(value), row.doc))
      end
    end
  end)
end

function testNaN()
  each_field(function(name, t, field, row)
    if row.kind ~= "number" and row.kind ~= "integer" then return end
    refuses(t, field, NAN, ("%s.%s is not a number (NaN): %s"):format(name, field, row.doc))
    refuses(t, field, -NAN, ("%s.%s is not a number (NaN): %s"):format(name, field, row.doc))
  end)
end

function testRanges()
  each_field(function(name, t, field, row)
    if row.kind ~= "number" and row.kind ~= "integer" then return end
    local unit = row.unit and " " .. row.unit or ""
    local function out_of(value, limit)
      refuses(t, field, value, ("%s.%s = %s must be %s%s: %s"):format(name, field, ("%g"):format(value), limit, unit, row.doc))
    end
    local low = row.above and ("above %g"):format(row.above) or row.min and ("at least %g"):format(row.min)
    if low then
      if row.above then out_of(row.above, low) end
      if row.above then out_of(-0.0, low) end
      out_of((row.above or row.min) - 1e3, low)
      out_of(-INF, low)
    end
    local high = ("at most %g"):format(row.max)
    out_of(INF, high)
    out_of(row.max * 4, high)
    if row.max < 1e15 then out_of(row.max + 1, high) end
  end)
end

function testWholeNumbers()
  each_field(function(name, t, field, row)
    if row.kind ~= "integer" then return end
    local value = math.max(row.min, 0) + 0.5
    refuses(t, field, value, ("%s.%s = %g must be a whole number: %s"):format(name, field, value, row.doc))
  end)
end

function testAFloatThatIsWholePasses()
  lu.assertEquals(venule.network {dim = 3.0}.dim, 3)
end

function testChoices()
  each_field(function(name, t, field, row)
    if row.kind ~= "choice" then return end
    for _, word in ipairs {"", "nonsense", row.choices .. "|", row.choices:upper()} do
      refuses(t, field, word, ('%s.%s = "%s" must be one of %s: %s'):format(name, field, word, row.choices, row.doc))
    end
  end)
end

local samples = {
  domain = disk, network = net, rng = rng, attractors = function() return venule.attractors {} end,
}
local shown = {domain = "venule.domain", network = "venule.network of 0", rng = "venule.rng", attractors = "venule.attractors of 0"}

function testObjectsOfAnotherClass()
  each_field(function(name, t, field, row)
    if not samples[row.kind] then return end
    local function expected(got) return ("%s.%s: %s expected, got %s (%s)"):format(name, field, row.kind, got, row.doc) end
    for kind, make in pairs(samples) do
      if kind ~= row.kind then refuses(t, field, make(), expected(shown[kind])) end
    end
    refuses(t, field, 1, expected "number")
    refuses(t, field, {}, expected "table")
  end)
end

function testClosedObjects()
  each_field(function(name, t, field, row)
    if not samples[row.kind] then return end
    local object = samples[row.kind]()
    object:close()
    refuses(t, field, object, ("%s.%s: %s expected, got venule.%s (closed) (%s)"):format(name, field, row.kind, row.kind, row.doc))
  end)
end

function testPoints()
  each_field(function(name, t, field, row)
    if row.kind ~= "point" then return end
    local what = name .. "." .. field
    refuses(t, field, 1, what .. ": a point {x, y} expected, got number")
    refuses(t, field, "1,2", what .. ": a point {x, y} expected, got string")
    refuses(t, field, {}, what .. ": a point has 2 or 3 coordinates, not 0")
    refuses(t, field, {1}, what .. ": a point has 2 or 3 coordinates, not 1")
    refuses(t, field, {1, 2, 3, 4}, what .. ": a point has 2 or 3 coordinates, not 4")
    refuses(t, field, {1, "2"}, what .. ": number expected, got string")
    refuses(t, field, {true, 2}, what .. ": number expected, got boolean")
  end)
end

function testPointsThatAreNotFinite()
  fails(function() domain.disk {center = {NAN, 0}} end, "disk.center must be finite")
  fails(function() domain.sphere {center = {0, 0, INF}} end, "sphere.center must be finite")
  fails(function() domain.box {min = {0, NAN}, max = {1, 1}} end, "box.max = 1 must be above box.min = nan in every direction, and finite")
  fails(function() domain.box {min = {0, 0}, max = {1, INF}} end, "box.max = inf must be above box.min = 0 in every direction, and finite")
  fails(function() canvas():text("a", {at = {0, INF}}) end, "text.at = (0, inf) is not finite")
  local ok, err = pcall(growth.marginal, {domain = disk(), origin = {0, INF}})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "origin")
  ok, err = pcall(growth.marginal, {domain = disk(), origin = {0, NAN}})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "origin")
end

function testMixedFields()
  fails(function() domain.profile {half_width = 3} end, "profile.half_width: a function of t or a table of numbers expected, got number")
  fails(function() domain.profile {half_width = {0, "1", 0}} end, "profile.half_width: number expected, got string")
  fails(function() venule.network {murray = 2} end, "murray: a table of options {…} expected, got number")
  fails(function() venule.network {murray = {exponant = 2}} end, 'murray: unknown field "exponant", did you mean "exponent"?')
  fails(function() venule.canvas {view = 3} end, "canvas.view: {min = {x, y}, max = {x, y}} expected, as domain:bounds() gives it, got number")
  fails(function() venule.canvas {view = {min = {0, 0}}} end, "canvas.view.max: a point {x, y} expected, got nil")
  fails(function() venule.canvas {view = {min = {0, 0}, max = {-1, 1}}} end, "canvas.view goes from 0 to -1 in x: give finite numbers, min below max")
  fails(function() canvas():stroke(net(), {width = "radios"}) end, 'stroke.width: "radius", a number or a function of the node expected, got radios')
  fails(function() canvas():stroke(net(), {width = "1"}) end, 'stroke.width: "radius", a number or a function of the node expected, got 1')
  fails(function() canvas():stroke(net(), {width = true}) end, 'stroke.width: "radius", a number or a function of the node expected, got boolean')
  fails(function() canvas():stroke(net(), {width = 0}) end, "stroke.width = 0 must be above 0 and finite (length)")
  fails(function() canvas():stroke(net(), {width = INF}) end, "stroke.width = inf must be above 0 and finite (length)")
end

function testCameras()
  local cube = {min = {0, 0, 0}, max = {1, 1, 1}}
  fails(function() venule.canvas {camera = 3, view = cube} end, "camera: a table of options {…} expected, got number")
  fails(function() venule.canvas {camera = {form = {1, 1, 1}}, view = cube} end, 'camera: unknown field "form", did you mean "from"?')
  fails(function() venule.canvas {camera = {}} end, "canvas.camera: a camera without `from` needs canvas.view, the bounds of what is to be seen")
  fails(function() venule.canvas {camera = {from = {1, 2, INF}}, view = cube} end, "camera.from = (1, 2, inf) must be finite, and within 1e100")
  fails(function() venule.canvas {camera = {from = {1, 2, 3}, to = {1, 2, 3}}} end, "camera.from and camera.to are both (1, 2, 3): the eye must be elsewhere")
  fails(function() venule.canvas {camera = {from = {0, 0, 9}, to = {0, 0, 0}, up = {0, 0, 1}}} end,
    "camera.up = (0, 0, 1) is the direction from `to` to `from`: give another one")
  fails(function() canvas():fill(domain.sphere {}) end, "fill: a domain of 3 dimensions has no area to fill; give a flat one, or the canvas a camera")
  local page = venule.canvas {width = 90, camera = {fov = 0}, view = cube}
  lu.assertEquals({page.width, page.height}, {90, 90})
  fails(function() page:fill(domain.sphere {} - domain.sphere {radius = 0.5}) end,
    'a domain of the kind "combination" has no surface of triangles; meshes, balls and boxes have')
end

function testWhatColoursTell()
  local n = net()
  n:add(n:root(0, 0), 1, 1)
  for _, by in ipairs {"tree", "birth", {1, 2}, {"red", "#00f"}, {NAN, INF}, function(i) return i end, function() return "teal" end} do
    canvas():stroke(n, {width = 1, color_by = by})
  end
  fails(function() canvas():stroke(n, {width = 1, color_by = 3}) end, "stroke.color_by: the name of a column, a list or a function of the node expected, got number")
  fails(function() canvas():stroke(n, {width = 1, color_by = "colour"}) end, 'stroke.color_by = "colour" must be one of radius|order|tree|birth|flow|pressure')
  fails(function() canvas():stroke(n, {width = 1, color_by = "order"}) end, 'stroke.color_by = "order": no orders are known; compute them first')
  fails(function() canvas():stroke(n, {width = 1, color_by = "radius"}) end, 'stroke.color_by = "radius": no radii are known')
  fails(function() canvas():stroke(n, {width = 1, color_by = {1}}) end, "stroke.color_by: number expected, got nil")
  fails(function() canvas():stroke(n, {width = 1, color_by = {"red", 2}}) end, "stroke.color_by: that of node 2: a colour expected, as before, got number")
  fails(function() canvas():stroke(n, {width = 1, color_by = {"red", "none"}}) end, 'stroke.color_by: that of node 2 = "none" must be opaque; opacity holds for all')
  fails(function() canvas():stroke(n, {width = 1, color_by = "tree", ramp = "red"}) end, "stroke.ramp has 1 colours: give two or more, between spaces")
  fails(function() canvas():stroke(n, {width = 1, color_by = function() n:add(1, 2, 2) return 1 end}) end, "stroke.color_by: the function must not change the network")
end

function testColours()
  fails(function() canvas():fill(disk(), {color = "gren"}) end, 'fill.color = "gren" is no colour (did you mean "green"?): give "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", one of the basic CSS names such as "teal", or "none"')
  fails(function() venule.canvas {background = "#12345"} end, 'canvas.background = "#12345" is no colour: give "#rgb", "#rgba", "#rrggbb", "#rrggbbaa", one of the basic CSS names such as "teal", or "none"')
  fails(function() venule.canvas {unit = "furlong"} end, 'canvas.unit = "furlong" is no length unit of a page: give "mm", "cm", "m", "um", "in", "pt" or ""')
end

function testWidthsAndDotsAreCountedFromOne()
  local n = net()
  n:root(0, 0)
  n:add(1, 1, 0)
  local f = function() canvas():stroke(n, {width = function(i) return i == 2 and -1 or 1 end}) end
  fails(f, "stroke.width: that of node 2 is -1; give 0 or more")
  fails(function() canvas():dots({{0, 0}, {0, NAN}}) end, "dots: point 2 = (0, nan) is not finite")
end

function testWhatGoesTogether()
  fails(function() venule.attractors {}:throw {domain = disk(), rng = rng()} end, "throw: give how many darts either as `count` or as `density`, above 0")
  fails(function() venule.attractors {}:throw {domain = disk(), rng = rng(), count = 1, density = 1} end, "throw: give how many darts either as `count` or as `density`, above 0")
  fails(function() venule.attractors {}:throw {domain = disk(), rng = rng(), count = 1, clearance = 1} end, "throw.clearance needs throw.network: the nodes to keep clear of")
  fails(function() venule.attractors {dim = 3}:throw {domain = disk(), rng = rng(), count = 1} end, "throw.domain has 2 dimensions, the attractors 3")
  fails(function() growth.marginal {domain = disk(), from = 3, to = 2} end, "marginal.from = 3 must not be above marginal.to = 2: a margin cannot shrink")
  fails(function() growth.marginal {domain = disk(), step = 1e-12} end, "marginal.step = 1e-12 takes more than 1e8 steps from 0.1 to 2; give a longer one")
  fails(function() domain.box {min = {0, 0}, max = {1, 1, 1}} end, "box: min and max must both have 2 coordinates, or both 3")
  fails(function() domain.box {min = {0, 1}, max = {1, 1}} end, "box.max = 1 must be above box.min = 1 in every direction, and finite")
end

-- Arguments that are no options.

function testArguments()
  local n = net()
  n:root(0, 0)
  fails(function() n:root("1", 0) end, "x: number expected, got string")
  fails(function() n:root(0) end, "y: number expected, got no value")
  fails(function() n:add(2, 0, 0) end, "network:add: node 2 is not one of the 1 there are")
  fails(function() n:add(0, 0, 0) end, "network:add: node 0 is not one of the 1 there are")
  fails(function() n:children(9) end, "network:children: node 9 is not one of the 1 there are")
  fails(function() n:orders("hicky") end, 'network:orders("hicky") must be one of strahler, horton, hickey')
  fails(function() n:scale("2") end, "network:scale: number expected, got string")
  fails(function() disk():contains(0) end, "y: number expected, got no value")
  fails(function() disk():contains(0, "0") end, "y: number expected, got string")
  fails(function() disk():sample(0, {rng = rng()}) end, "domain:sample(0): from 1 to 100,000,000 points")
  fails(function() rng():uniform(2, 1) end, "rng:uniform(2, 1): the first must not be above the second")
  fails(function() rng():uniform("0", 1) end, "rng:uniform low: number expected, got string")
  fails(function() rng():normal(0, -1) end, "rng:normal: a standard deviation of -1 must be 0 or more")
  fails(function() rng():integer(2, 1) end, "rng:integer(2, 1): the first must not be above the second")
  fails(function() venule.rng(1.5) end, "rng seed: whole number expected, got 1.5")
  fails(function() venule.attractors {}:add(NAN, 0) end, "an attractor at (nan, 0, 0) is not finite")
  fails(function() growth.none {domain = disk()}:advance(rng()) end, "growth:advance: networks and attractors expected, got userdata")
end

function testObjectsAsArguments()
  local a, n = venule.attractors {}, net()
  fails(function() a:influence(rng()) end, "bad argument #1 to 'influence' (network expected, got venule.rng)")
  fails(function() a:consume(a, {distance = 1}) end, "bad argument #1 to 'consume' (network expected, got venule.attractors)")
  fails(function() n:extend(n, {length = 1}) end, "bad argument #1 to 'extend' (influence expected, got venule.network)")
  fails(function() canvas():fill(n) end, "bad argument #1 to 'fill' (domain expected, got venule.network)")
  n:close()
  fails(function() n:root(0, 0) end, "this network is closed")
  fails(function() a:influence(n) end, "this network is closed")
  lu.assertEquals(tostring(n), "venule.network (closed)")
  n:close() -- twice is once
end

function testOutlines()
  fails(function() domain.polygon {} end, "polygon: the outline is empty; give 3 points or more")
  fails(function() domain.polygon {{{0, 0}, {1, 0}}} end, "polygon: ring 1 has 2 points; an outline needs 3 or more")
  fails(function() domain.polygon {{{0, 0}, {1, 0}, {0, "1"}}} end, "polygon: number expected, got string")
  fails(function() domain.polygon {{{0, 0}, {1, 0}, {0, 1}}, 3} end, "polygon: a ring {{x, y}, …} expected, got number")
  fails(function() domain.polygon(3) end, "bad argument #1 to 'polygon' (table expected, got number)")
  local ok, err = pcall(domain.polygon, {{0, 0}, {2, 2}, {2, 0}, {0, 2}})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "polygon")
  lu.assertStrContains(err, "cross")
  ok, err = pcall(domain.polygon, {{0, 0}, {1, NAN}, {1, 1}})
  lu.assertFalse(ok)
  lu.assertStrContains(err, "finite")
end

-- Strict reads.

function testReadsOfUnknownFields()
  local n, a, f = net(), venule.attractors {}, influence()
  fails(function() local _ = n.raduis end, 'network has no "raduis", did you mean "radius"?')
  fails(function() n:childern(1) end, 'network has no "childern", did you mean "children"?')
  fails(function() local _ = n.qqqqqq end, 'network has no "qqqqqq"')
  fails(function() local _ = n[1] end, 'network has no "1"')
  fails(function() local _ = a.dormnt end, 'attractors has no "dormnt", did you mean "dormant"?')
  fails(function() local _ = disk().bound end, 'domain has no "bound", did you mean "bounds"?')
  fails(function() local _ = rng().unifrom end, 'rng has no "unifrom", did you mean "uniform"?')
  fails(function() local _ = f.pair end, 'influence has no "pair", did you mean "pairs"?')
  fails(function() local _ = canvas().heigth end, 'canvas has no "heigth", did you mean "height"?')
  fails(function() local _ = growth.none {domain = disk()}.lenght end, 'growth has no "lenght", did you mean "length"?')
end

function testAssignmentsAreRefused()
  local n = net()
  fails(function() n.x = 1 end, "network.x cannot be set")
  fails(function() n.radius = {} end, "network.radius cannot be set")
  fails(function() disk().dim = 3 end, "domain.dim cannot be set")
  fails(function() n.x[1] = 2 end, "columns cannot be written to")
end

function testColumns()
  local n = net()
  lu.assertEquals(#n.x, 0)
  n:root(1, 2)
  n:add(1, 3, 4)
  n:add(2, 5, 6)
  local x = n.x
  lu.assertEquals(#x, 3)
  lu.assertEquals({x[1], x[2], x[3]}, {1, 3, 5})
  lu.assertNil(x[0])
  lu.assertNil(x[-1])
  lu.assertNil(x[4])
  lu.assertNil(x[math.maxinteger])
  lu.assertNil(x[math.mininteger])
  local seen = {}
  for i, y in ipairs(n.y) do seen[i] = y end
  lu.assertEquals(seen, {2, 4, 6})
  n:add(3, 7, 8)
  lu.assertEquals(x[4], 7) -- the view reads what is there now
  lu.assertEquals({n.parent[1], n.parent[2], n.parent[3], n.parent[4]}, {0, 1, 2, 3})
  lu.assertEquals(n.z[1], 0)
  fails(function() local _ = x["1"] end, "a column is read by whole numbers from 1, not by 1")
  fails(function() local _ = x[1.5] end, "a column is read by whole numbers from 1, not by 1.5")
  fails(function() local _ = x.raduis end, "a column is read by whole numbers from 1, not by raduis")
  fails(function() local _ = n.order[1] end, 'network.order is not known: call net:orders("hickey") after the last change')
  n:close()
  fails(function() local _ = x[1] end, "this network is closed")
end

-- The reader of what is written in Lua says the same words.

local function venation(field, value)
  local o = {domain = disk(), rng = rng(), darts = 1, birth_distance = 1}
  if field then o[field] = value end
  return o
end

function testVenation()
  fails(function() venule.venation(venation("kil_distance", 1)) end, 'venation: unknown field "kil_distance", did you mean "kill_distance"?')
  fails(function() venule.venation(venation("qqqqqqqqqqq", 1)) end, 'venation: unknown field "qqqqqqqqqqq"')
  fails(function() venule.venation(venation(1, 1)) end, 'venation: unknown field "1"')
  fails(function() venule.venation(3) end, "venation: a table of options {…} expected, got number")
  fails(function() venule.venation() end, "venation: a table of options {…} expected, got nil")
  fails(function() venule.venation {rng = rng(), darts = 1} end, "venation: `domain` is missing: a blade that grows (venule.growth), or a domain that stays")
  fails(function() venule.venation {domain = disk(), darts = 1} end, "venation: `rng` is missing: the random numbers: venule.rng(seed)")
  fails(function() venule.venation {domain = disk(), rng = rng()} end, "venation: `darts` is missing: ρ: darts thrown per area and step; under marginal growth, per area once")
  local doc = {
    kill_distance = "d_k: a vein this close consumes its source", segment_length = "D: the length a vein gains in a step",
    birth_distance = "b_s: a new source keeps this far from other sources",
    vein_distance = "b_v: and this far from veins; left out: birth_distance",
    attraction_distance = "sources farther than this draw no vein; left out: any distance",
  }
  for field, text in pairs(doc) do
    fails(function() venule.venation(venation(field, "1")) end, ("venation.%s: number expected, got string: %s"):format(field, text))
    fails(function() venule.venation(venation(field, 0)) end, ("venation.%s = 0 must be above 0 length: %s"):format(field, text))
    fails(function() venule.venation(venation(field, -2.5)) end, ("venation.%s = -2.5 must be above 0 length: %s"):format(field, text))
    fails(function() venule.venation(venation(field, NAN)) end, ("venation.%s is not a number (NaN): %s"):format(field, text))
  end
  fails(function() venule.venation(venation("vein_steps", 1.5)) end, "venation.vein_steps: whole number expected, got 1.5: vein steps to one growth step; left out: as many as keep pace with the tip")
  fails(function() venule.venation(venation("vein_steps", 0)) end, "venation.vein_steps = 0 must be from 1 to 1000: vein steps to one growth step; left out: as many as keep pace with the tip")
  fails(function() venule.venation(venation("vein_steps", 1001)) end, "venation.vein_steps = 1001 must be from 1 to 1000: vein steps to one growth step; left out: as many as keep pace with the tip")
  fails(function() venule.venation(venation("stop", "late")) end, 'venation.stop = "late" must be one of reached, grown: end when every source is reached, or as soon as the blade is grown')
  fails(function() venule.venation(venation("stop", 1)) end, "venation.stop: string expected, got number: end when every source is reached, or as soon as the blade is grown")
  fails(function() venule.venation(venation("roots", 1)) end, "venation.roots: table expected, got number: seed points {{x, y}, …}; left out: the lowest point of the blade")
  fails(function() venule.venation(venation("domain", 1)) end, "venation.domain: userdata expected, got number: a blade that grows (venule.growth), or a domain that stays")
  local without = venation()
  without.birth_distance = nil
  fails(function() venule.venation(without) end, "venation: `birth_distance` is missing: on a blade that stays, sources would never cease to appear without it")
  fails(function() venule.venation(venation("murray", {exponent = 0})) end, "murray.exponent = 0 must be above 0: n in r_parent^n = Σ r_child^n: 3 by Murray, 2 in most of Runions' leaves")
end

function testVenationWithObjectsOfAnotherClass()
  fails(function() venule.venation(venation("domain", rng())) end, "none.domain: domain expected, got venule.rng (the shape, which stays as it is)")
  local closed = disk()
  closed:close()
  fails(function() venule.venation(venation("domain", closed)) end, "none.domain: domain expected, got venule.domain (closed) (the shape, which stays as it is)")
  closed = growth.none {domain = disk()}
  closed:close()
  fails(function() venule.venation(venation("domain", closed)) end, "this growth is closed")
  fails(function() venule.venation(venation("rng", disk())):step() end, "throw.rng: rng expected, got venule.domain (the random numbers: venule.rng(seed))")
end

function testRun()
  local s = venule.venation(venation())
  fails(function() s:run {progres = print} end, 'run: unknown field "progres", did you mean "progress"?')
end

function testParam()
  local row = 'param: a row is {"name", default, min=, max=, choices=, unit=, help=, file=}'
  fails(function() venule.param(3) end, "param: a table of rows expected, got number")
  fails(function() venule.param {3} end, row)
  fails(function() venule.param {{}} end, row)
  fails(function() venule.param {{"a"}} end, row)
  fails(function() venule.param {{3, 3}} end, row)
  fails(function() venule.param {{"a", {}}} end, row)
  fails(function() venule.param {{"a", 1, mn = 0}} end, 'param.a: unknown field "mn", did you mean "min"?')
  fails(function() venule.param {{"a", 1, 2}} end, 'param.a: unknown field "3"')
  fails(function() venule.param {{"a", 1, min = "0"}} end, "param.a.min: number expected, got string")
  fails(function() venule.param {{"a", 1, choices = 1}} end, "param.a.choices: table expected, got number")
  fails(function() venule.param {{"a", 1, file = 1}} end, "param.a.file: boolean expected, got number")
  fails(function() venule.param {{"a", 1, min = 2}} end, "param.a = 1 must be at least 2 (its own default)")
  fails(function() venule.param {{"a", 1, max = 0, help = "what"}} end, "param.a = 1 must be at most 0: what (its own default)")
  fails(function() venule.param {{"a", 9, min = 0, max = 1, unit = "mm"}} end, "param.a = 9 must be from 0 to 1 mm (its own default)")
  fails(function() venule.param {{"a", NAN}} end, "param.a is not a number (NaN) (its own default)")
  fails(function() venule.param {{"a", "b", choices = {"c", "d"}}} end, 'param.a = "b" must be one of c, d (its own default)')
end

function testParamReads()
  local p = venule.param {{"kill_distance", 1, min = 0.1, max = 40, help = "how near"}}
  lu.assertEquals(p.kill_distance, 1)
  lu.assertEquals(p.seed, 1)
  fails(function() local _ = p.kil_distance end, 'param: no parameter "kil_distance", did you mean "kill_distance"?')
  fails(function() local _ = p.qqqqqq end, 'param: no parameter "qqqqqq"')
end

function testResult()
  fails(function() venule.result(3) end, "result: a table of options {…} expected, got number")
  fails(function() venule.result() end, "result: a table of options {…} expected, got nil")
  fails(function() venule.result {netwrok = net()} end, 'result: unknown field "netwrok", did you mean "network"?')
  fails(function() venule.result {net()} end, 'result: unknown field "1"')
  fails(function() venule.result {width = 0} end, "result.width = 0 must be above 0 pixels: of the canvas that picture is given")
  fails(function() venule.result {width = "9"} end, "result.width: number expected, got string: of the canvas that picture is given")
  fails(function() venule.result {height = NAN} end, "result.height is not a number (NaN): of the canvas that picture is given")
  fails(function() venule.result {background = 1} end, "result.background: string expected, got number: of the canvas that picture is given")
  fails(function() venule.result {networks = 1} end, "result.networks: table expected, got number: several networks by name")
  fails(function() venule.result {network = 1} end, "result.network: userdata expected, got number: the network that grew")
  fails(function() venule.result {picture = 1} end, "result.picture: a canvas or a function expected, got number")
end
