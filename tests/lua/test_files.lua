-- Files: what is read back is what was written, the same twice, whole or not there.
local venule = require "venule"
local lu = require "luaunit"

local domain = venule.domain

local function fails(f, message)
  local info = debug.getinfo(f, "S")
  local ok, err = pcall(f)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertEquals(err, ("%s:%d: %s"):format(info.short_src, info.linedefined, message))
end

-- A folder of this run's own. Each test asks for names in it; at the end it must be empty and can go.
local base = os.tmpname()
os.remove(base)
assert(os.execute(("mkdir '%s'"):format(base)))
local used = {}

local function temporary(name)
  local path = base .. "/" .. name
  used[#used + 1] = path
  return path
end

local function bytes_of(path)
  local file = io.open(path, "rb")
  if not file then return nil end
  local bytes = file:read "a"
  file:close()
  return bytes
end

local function write(path, text)
  local file = assert(io.open(path, "wb"))
  file:write(text)
  file:close()
end

local function names_in_folder()
  local list = io.popen(("ls -A '%s'"):format(base))
  local text = list:read "a"
  list:close()
  return text
end

local function assert_folder_holds(...)
  local names = {...}
  table.sort(names)
  lu.assertEquals(names_in_folder(), #names > 0 and table.concat(names, "\n") .. "\n" or "")
end

TestFiles = {}

function TestFiles:tearDown()
  for _, path in ipairs(used) do os.remove(path) end
  used = {}
  assert_folder_holds() -- nothing else was left behind
end

-- luaunit runs functions by name: this one comes last.
function testzzTheFolderIsEmpty()
  lu.assertTrue(os.remove(base))
end

local function grown(dim, seed)
  local auxin, net = venule.attractors {dim = dim}, venule.network {dim = dim, unit = "mm", murray = {exponent = 3, tip_radius = 0.1}}
  local shape = dim == 3 and domain.sphere {radius = 5} or domain.disk {radius = 5}
  auxin:throw {domain = shape, count = 80, spacing = 0.5, rng = venule.rng(seed)}
  net:root(0, 0, 0)
  for _ = 1, 60 do
    net:extend(auxin:influence(net), {length = 0.3})
    auxin:consume(net, {distance = 0.35})
  end
  return net
end

local function assert_same(a, b)
  lu.assertEquals({#b, b.dim, b.unit}, {#a, a.dim, a.unit})
  for _, column in ipairs {"x", "y", "z", "parent", "radius", "tree", "birth"} do
    for i = 1, #a do
      if a[column][i] ~= b[column][i] then
        lu.fail(("%s of node %d was %.17g and is %.17g"):format(column, i, a[column][i], b[column][i]))
      end
    end
  end
  lu.assertEquals(b:joins(), a:joins())
  lu.assertEquals(b:measure(), a:measure())
end

function TestFiles:testRoundTrip()
  for _, dim in ipairs {2, 3} do
    local net = grown(dim, 4)
    net:join(1, #net, 0.25)
    lu.assertTrue(#net > 50)
    local path = temporary(("net%d.json"):format(dim))
    net:save(path)
    local back = venule.load(path)
    assert_same(net, back)
    local again = temporary(("again%d.json"):format(dim))
    back:save(again)
    lu.assertTrue(bytes_of(path) == bytes_of(again), "what was read back is written in other bytes")
  end
end

function TestFiles:testOrdersComeBack()
  local net = grown(2, 4)
  for _, kind in ipairs {"strahler", "horton", "hickey"} do
    net:orders(kind)
    net:save(temporary "orders.json")
    local back = venule.load(base .. "/orders.json")
    for i = 1, #net do lu.assertEquals(back.order[i], net.order[i]) end
  end
end

-- What each format keeps; a law of radii only JSON does.
function TestFiles:testEveryFormat()
  local all = {"x", "y", "z", "parent", "radius", "tree", "birth"}
  local most = {"x", "y", "z", "parent", "radius", "tree"}
  local kept = {json = all, vtp = all, csv = all, xml = most, gxl = most, swc = most, txt = {}}
  local formats = venule.formats()
  lu.assertEquals(formats[1], "json")
  for _, format in ipairs(formats) do
    local net = grown(3, 4)
    local path = temporary("net." .. format)
    lu.assertTrue(venule.can_save(path, net))
    net:save(path)
    local back = venule.load(path)
    lu.assertEquals(#back, #net)
    lu.assertAlmostEquals(back:measure().length, net:measure().length, 1e-9)
    for _, column in ipairs(kept[format]) do
      for i = 1, #net do lu.assertEquals(back[column][i], net[column][i], format .. ", " .. column) end
    end
  end
end

function TestFiles:testWhatAFormatCannotHold()
  local net, path = grown(2, 4), temporary "net.swc"
  net:join(1, #net)
  local why = path .. ": such a file holds trees, but 1 joins close loops; save it as .json, .xml, .gxl or .vtp"
  lu.assertEquals({venule.can_save(path, net)}, {false, why})
  fails(function() net:save(path) end, why)
  path = temporary "both.xml"
  why = path .. ": such a file holds one network, not 2; save each to its own, or all as .json"
  fails(function() venule.save(path, {a = net, b = net}) end, why)
  lu.assertEquals({venule.can_save(path, {a = net, b = net})}, {false, why})
  lu.assertTrue(venule.can_save(path, {a = net}))
  assert_folder_holds()
end

function TestFiles:testAFileOfOpenCCO()
  local net = venule.load "../files/gxl/opencco-2d.xml"
  lu.assertEquals({#net, net.dim, net.radius[4], net.parent[3]}, {4, 2, 1.29, 2})
end

function TestFiles:testAWholeNetworkGrowsOn()
  local net = grown(2, 4)
  net:save(temporary "net.json")
  local back = venule.load(base .. "/net.json")
  lu.assertEquals(back:add(#back, 9, 9), #net + 1)
  lu.assertEquals(back:children(#net), {#net + 1})
end

function TestFiles:testSeveralByName()
  local path = temporary "both.json"
  local arteries, veins = grown(3, 1), grown(3, 2)
  venule.save(path, {veins = veins, arteries = arteries})
  local back = venule.load(path)
  lu.assertEquals(type(back), "table")
  assert_same(arteries, back.arteries)
  assert_same(veins, back.veins)
  back.arteries, back.veins = nil, nil
  lu.assertEquals(back, {})
  local again = temporary "again.json"
  venule.save(again, {arteries = arteries, veins = veins})
  lu.assertTrue(bytes_of(path) == bytes_of(again))
end

function TestFiles:testOneByVenuleSave()
  local net = grown(2, 3)
  local one, other = temporary "one.json", temporary "other.json"
  venule.save(one, net)
  net:save(other)
  lu.assertTrue(bytes_of(one) == bytes_of(other))
  assert_same(net, venule.load(one))
end

function TestFiles:testAnEmptyNetwork()
  local path = temporary "empty.json"
  venule.network {}:save(path)
  lu.assertEquals(#venule.load(path), 0)
end

-- Awkward numbers come back as they were.
function TestFiles:testNumbers()
  local net, path = venule.network {}, temporary "numbers.json"
  local values = {0.1, 1 / 3, 1e-300, -1e300, 5e-324, 123456789.123456789, -0.0, 2 ^ 53}
  for i, value in ipairs(values) do net:root(value, -values[#values + 1 - i]) end
  net:save(path)
  local back = venule.load(path)
  for i, value in ipairs(values) do
    lu.assertEquals(("%a"):format(back.x[i]), ("%a"):format(value))
  end
end

function TestFiles:testAFileIsReplacedWhole()
  local path = temporary "net.json"
  write(path, ("x"):rep(1000000))
  local net = venule.network {}
  net:root(1, 2)
  net:save(path)
  lu.assertEquals(venule.load(path).x[1], 1)
  assert_folder_holds "net.json"
end

-- Pictures.

local function picture()
  local shape = domain.disk {radius = 6}
  local page = venule.canvas {width = 300, view = shape:bounds(), background = "white", unit = "mm"}
  page:fill(shape, {color = "#dfe9c8", stroke = "#555", line_width = 0.2})
  page:stroke(grown(2, 4), {color = "teal", opacity = 0.8})
  page:dots({{1, 1}, {-2, 3}}, {radius = 0.2})
  page:text("Größe <&> \"x\"", {at = {0, -5}, anchor = "middle"})
  return page
end

local starts = {png = "^\137PNG\r\n\26\n", svg = "^<%?xml", pdf = "^%%PDF%-", eps = "^%%!PS%-Adobe%-3.0 EPSF%-3.0\n"}
local ends = {png = "IEND\174B`\130$", svg = "</svg>%s*$", pdf = "%%%%EOF%s*$", eps = "%%%%EOF%s*$"}

function TestFiles:testPicturesAreTheSameTwice()
  for kind, start in pairs(starts) do
    local one, other = temporary("one." .. kind), temporary("other." .. kind)
    local page = picture()
    page:save(one)
    page:save(one) -- twice the same canvas
    picture():save(other)
    local bytes = bytes_of(one)
    lu.assertTrue(#bytes > 500, kind .. " is small")
    lu.assertTrue(bytes:find(start) == 1, kind .. " does not begin as it should")
    lu.assertTrue(bytes:find(ends[kind]) ~= nil, kind .. " does not end as it should")
    lu.assertTrue(bytes == bytes_of(other), kind .. " differs from run to run")
  end
end

function TestFiles:testExtensionsInCapitals()
  picture():save(temporary "LEAF.PNG")
  lu.assertTrue(bytes_of(base .. "/LEAF.PNG"):find(starts.png) == 1)
end

function TestFiles:testSvgIsInMillimetres()
  local path = temporary "leaf.svg"
  picture():save(path)
  local head = bytes_of(path):match "<svg.->"
  lu.assertStrMatches(head, '.*width="[%d.]+mm".*')
  lu.assertStrMatches(head, '.*height="[%d.]+mm".*')
  lu.assertStrMatches(head, '.*viewBox="[%d. -]+".*')
  lu.assertStrContains(bytes_of(path), "Größe &lt;&amp;&gt;")
end

function TestFiles:testAnSvgOfOursCanBeGrownOn()
  local path = temporary "shape.svg"
  local page = venule.canvas {view = {min = {0, 0}, max = {40, 30}}, width = 400, margin = 0, unit = "mm"}
  page:fill(domain.box {min = {5, 10}, max = {25, 20}}, {color = "green"})
  page:save(path)
  local shape = domain.svg(path)
  lu.assertEquals(shape.unit, "mm")
  local bounds = shape:bounds()
  for k, value in ipairs {5, 10} do lu.assertAlmostEquals(bounds.min[k], value, 1e-2) end
  for k, value in ipairs {25, 20} do lu.assertAlmostEquals(bounds.max[k], value, 1e-2) end
end

-- Errors leave nothing.

function TestFiles:testUnknownExtensions()
  local page, net = picture(), grown(2, 4)
  local path = temporary "leaf.gif"
  fails(function() page:save(path) end, path .. ": a picture is written as .png, .svg, .pdf or .eps")
  path = temporary "leaf"
  fails(function() page:save(path) end, path .. ": a picture is written as .png, .svg, .pdf or .eps")
  path = temporary "leaf.png.x"
  fails(function() page:save(path) end, path .. ": a picture is written as .png, .svg, .pdf or .eps")
  assert_folder_holds()
end

function TestFiles:testAFolderThatIsNotThere()
  local path = base .. "/none/leaf"
  for _, extension in ipairs {"png", "svg", "pdf", "eps"} do
    local name = path .. "." .. extension
    local page = picture()
    fails(function() page:save(name) end, name .. ": cannot be written: No such file or directory")
  end
  local net = grown(2, 4)
  fails(function() net:save(path .. ".json") end, path .. ".json: cannot be written: No such file or directory")
  fails(function() venule.save(path .. ".json", {a = net}) end, path .. ".json: cannot be written: No such file or directory")
  fails(function() net:save(base) end, base .. ": networks are written as .json, .xml, .gxl, .vtp, .swc, .csv or .txt; give such a name")
  assert_folder_holds()
end

function TestFiles:testAFailureKeepsTheOldFile()
  local path = temporary "net.json"
  write(path, "old")
  local flat, solid = grown(2, 4), grown(3, 4)
  lu.assertFalse(pcall(venule.save, path, {a = flat, [1] = solid}))
  lu.assertEquals(bytes_of(path), "old")
  assert_folder_holds "net.json"
end

function TestFiles:testWhatSaveRefuses()
  local net = grown(2, 4)
  local path = temporary "net.json"
  fails(function() venule.save(path, {net}) end, "save: a table {name = network, …} of at most 256 expected")
  fails(function() venule.save(path, 3) end, "bad argument #2 to 'save' (table expected, got number)")
  fails(function() net:save() end, "bad argument #1 to 'save' (string expected, got no value)")
  lu.assertFalse(pcall(venule.save, path, {a = 3}))
  assert_folder_holds()
end

-- Broken files: one line with the file's name.
function TestFiles:testBrokenNetworks()
  local whole = temporary "whole.json"
  grown(2, 4):save(whole)
  local text = bytes_of(whole)
  local broken = {
    "", " ", "{", "[]", "null", "7", "{}", '{"format": "venule.network"}', "<svg/>", "\0\0\0",
    text:sub(1, #text // 2), text:sub(1, -3), text .. "x", (text:gsub('"version": *1', '"version": 99')),
    (text:gsub("venule%.network", "venule.newtork")), (text:gsub('"dim": *2', '"dim": 4')),
    (text:gsub('"x": *%[', '"x": ["a", ')), (text:gsub('"x": *%[', '"x": [1, ')), (text:gsub('"parent": *%[%-1', '"parent": [5')),
    (text:gsub('"parent": *%[%-1', '"parent": [9999999')), (text:gsub('"parent": *%[%-1', '"parent": [0')),
  }
  local path = temporary "broken.json"
  for i, bytes in ipairs(broken) do
    write(path, bytes)
    local ok, err = pcall(venule.load, path)
    lu.assertFalse(ok, ("broken file %d was read: %s"):format(i, bytes:sub(1, 60)))
    lu.assertStrContains(err, path)
    lu.assertNotStrContains(err, "\n")
  end
end

function TestFiles:testAMissingNetwork()
  local path = base .. "/missing.json"
  fails(function() venule.load(path) end, path .. ": cannot be read: No such file or directory")
end

-- Every cut of a file is refused, and nothing of it stays in memory (the runner counts bytes at the end).
function TestFiles:testEveryCutIsRefused()
  local whole, path = temporary "whole.json", temporary "cut.json"
  local net = venule.network {unit = "mm", murray = {}}
  net:root(1, 2)
  net:add(1, 3, 4)
  net:add(2, 5, 6)
  net:join(1, 3)
  net:save(whole)
  local text = bytes_of(whole):gsub("%s+$", "")
  for cut = 0, #text - 1 do
    write(path, text:sub(1, cut))
    lu.assertFalse(pcall(venule.load, path), "cut at " .. cut)
  end
end

-- Outlines in SVG files.
function TestFiles:testBrokenOutlines()
  local folder = "../files/svg/" -- beside this file
  for _, name in ipairs {"bad-path", "crossing", "empty", "no-shapes", "unclosed", "cyclic-use", "entity-bomb", "missing"} do
    local ok, err = pcall(domain.svg, folder .. name .. ".svg")
    lu.assertFalse(ok, name .. " was read")
    lu.assertStrContains(err, name .. ".svg")
    lu.assertNotStrContains(err, "\n")
  end
  local ok, err = pcall(domain.svg, folder .. "crossing.svg")
  lu.assertFalse(ok)
  lu.assertStrContains(err, "cross")
  lu.assertTrue(domain.svg(folder .. "crossing.svg", {["repair"] = true}):measure() > 0)
end
