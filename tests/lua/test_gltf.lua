-- glTF meshes: a box by its scene's transforms, in all the ways that triangles are listed; and files that lie.
local venule = require "venule"
local lu = require "luaunit"

local base = os.tmpname()

-- Positions and corners of a box of side 2 about the origin.
local function box_bytes(format)
  local positions, corners = {}, {}
  for i = 0, 7 do
    positions[#positions + 1] = ("<fff"):pack(i // 4 * 2 - 1, i // 2 % 2 * 2 - 1, i % 2 * 2 - 1)
  end
  for _, q in ipairs {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1}, {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}} do
    for _, k in ipairs {1, 2, 3, 1, 3, 4} do corners[#corners + 1] = (format or "<I2"):pack(q[k]) end
  end
  return table.concat(positions), table.concat(corners)
end

local function json(change)
  local text = [[{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
    "nodes":[{"children":[1],"translation":[10,0,0]},{"mesh":0,"scale":[1,2,3]}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":8,"type":"VEC3","min":[-1,-1,-1],"max":[1,1,1]},
                 {"bufferView":1,"componentType":5123,"count":36,"type":"SCALAR"}],
    "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":96},{"buffer":0,"byteOffset":96,"byteLength":72}],
    "buffers":[{"byteLength":168}]}]]
  for from, to in pairs(change or {}) do
    local begin, finish = text:find(from, 1, true)
    text = text:sub(1, begin - 1) .. to .. text:sub(finish + 1)
  end
  return text
end

local function glb(text, bytes)
  text = text .. (" "):rep(-#text % 4)
  bytes = bytes .. ("\0"):rep(-#bytes % 4)
  return ("<c4I4I4"):pack("glTF", 2, 28 + #text + #bytes) .. ("<I4c4"):pack(#text, "JSON") .. text
    .. ("<I4c4"):pack(#bytes, "BIN\0") .. bytes
end

local function load(content, extension)
  local path = base .. (extension or ".glb")
  local file = assert(io.open(path, "wb"))
  file:write(content)
  file:close()
  local ok, domain = pcall(venule.domain.mesh, path, {on = "inside"})
  os.remove(path)
  return ok, domain
end

local function fails(content, message, extension)
  local ok, err = load(content, extension)
  lu.assertFalse(ok, "no error, where this was expected: " .. message)
  lu.assertStrContains(err, message)
end

TestGltf = {}

function TestGltf:tearDown() os.remove(base) end

function TestGltf:testTheSceneStandsWhereItsNodesSay()
  local positions, corners = box_bytes()
  local ok, box = load(glb(json(), positions .. corners))
  lu.assertTrue(ok, box)
  lu.assertAlmostEquals(box:measure(), 48, 1e-9)
  lu.assertEquals(box:bounds().min, {9, -2, -3})
  lu.assertEquals(box:bounds().max, {11, 2, 3})
end

-- A quarter turn about z, as a quaternion and as a matrix.
function TestGltf:testRotation()
  local positions, corners = box_bytes()
  local half = math.sqrt(0.5)
  for _, turn in ipairs {('"rotation":[0,0,%.17g,%.17g]'):format(half, half), '"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1]'} do
    local ok, box = load(glb(json {['"translation":[10,0,0]'] = turn}, positions .. corners))
    lu.assertTrue(ok, box)
    lu.assertAlmostEquals(box:bounds().max[1], 2, 1e-6)
    lu.assertAlmostEquals(box:bounds().max[2], 1, 1e-6)
  end
end

function TestGltf:testFilesThatLie()
  local positions, corners = box_bytes()
  local bytes = positions .. corners
  fails(glb(json {['"count":8'] = '"count":400000000'}, bytes), "an accessor claims 400000000 items")
  fails(glb(json {['"byteOffset":96'] = '"byteOffset":90000'}, bytes), "more than its buffer's bytes")
  fails(glb(json {['"mesh":0'] = '"mesh":0,"children":[0]'}, bytes), "its nodes are no tree")
  fails(glb(json {['"mesh":0'] = '"mesh":7'}, bytes), "it names mesh 7, and has 1")
  fails(glb(json {['"asset"'] = '"extensionsRequired":["KHR_draco_mesh_compression"],"asset"'}, bytes), "it needs KHR_draco_mesh_compression")
  fails(glb(json {['"indices":1'] = '"indices":1,"mode":1'}, bytes), "its scene has no triangles")
  fails(glb(json {['"count":36'] = '"count":35'}, positions .. ("<I2"):pack(200) .. corners:sub(3)), "a triangle has corner 200 of 8")
  fails(glb(json(), bytes):sub(1, 300), "no glTF, or a broken one")
  fails("", "no glTF, or a broken one", ".gltf")
  fails(json {['"byteLength":168'] = '"byteLength":168,"uri":"../../etc/passwd"'}, "no glTF, or a broken one", ".gltf")
  fails(json {['"byteLength":168'] = '"byteLength":168,"uri":"/etc/passwd"'}, "no glTF, or a broken one", ".gltf")
end

-- Whatever single byte is spoiled: a domain, or one line that says what is wrong.
function TestGltf:testSpoiledBytes()
  local positions, corners = box_bytes()
  local content = glb(json(), positions .. corners)
  local rng = venule.rng(4)
  for _ = 1, 400 do
    local at = rng:integer(1, #content)
    local ok, err = load(content:sub(1, at - 1) .. string.char(rng:integer(0, 255)) .. content:sub(at + 1))
    if not ok then lu.assertNotStrContains(err, "\n") end
  end
end
