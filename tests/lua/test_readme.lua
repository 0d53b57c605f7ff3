-- The script that README.md shows must run as it stands there, through the program, and write what it says.
local lu = require "luaunit"

local here = debug.getinfo(1, "S").source:match "^@(.*/)" or "./"
local root = here .. "../../"
local program = os.getenv "VENULE" or "build/venule"

local function quoted(text)
  return "'" .. text:gsub("'", "'\\''") .. "'"
end

local function run(command)
  local pipe = assert(io.popen(command .. " 2>&1"))
  local text = pipe:read "a"
  local _, how, code = pipe:close()
  return code, text, how
end

local function output_of(command)
  local code, text = run(command)
  lu.assertEquals(code, 0, command .. ": " .. text)
  return (text:gsub("\n$", ""))
end

-- The first ```lua block, and what README.md is.
local function readme_script()
  local file = io.open(root .. "README.md", "rb")
  if not file then lu.fail("README.md is missing: " .. root .. "README.md cannot be read") end
  local text = file:read "a"
  file:close()
  local block = ("\n" .. text):match "\n```lua\r?\n(.-)\n```"
  if not block then lu.fail "README.md shows no script: it has no ```lua block" end
  return block
end

local folder

TestReadme = {}

function TestReadme:setUp()
  folder = output_of "mktemp -d"
end

function TestReadme:tearDown()
  if folder and #folder > 5 then os.execute("rm -rf " .. quoted(folder)) end
end

-- It is run at the top of a copy of what it may name: scripts/ and its outlines.
local function place(script)
  lu.assertEquals(run(("cp -R %s %s"):format(quoted(root .. "scripts"), quoted(folder .. "/scripts"))), 0)
  local path = folder .. "/scripts/readme.lua"
  local file = assert(io.open(path, "wb"))
  file:write(script, "\n")
  file:close()
  return path
end

local function size_of(path)
  local file = io.open(path, "rb")
  if not file then return nil end
  local size = file:seek "end"
  file:close()
  return size
end

local function absolute(path)
  return path:sub(1, 1) == "/" and path or output_of "pwd" .. "/" .. path
end

function TestReadme:testTheScriptRunsAndWrites()
  local path = place(readme_script())
  local command = ("cd %s && %s run %s -o leaf.svg -o leaf.png --seed 3"):format(quoted(folder), quoted(absolute(program)), quoted(path))
  local code, text = run(command)
  lu.assertEquals(code, 0, text)
  lu.assertStrContains(text, "leaf.svg")
  lu.assertStrContains(text, "leaf.png")
  for _, name in ipairs {"leaf.svg", "leaf.png"} do
    local size = size_of(folder .. "/" .. name)
    lu.assertNotNil(size, name .. " was not written")
    lu.assertTrue(size > 1000, name .. " is nearly empty")
  end
  local svg = assert(io.open(folder .. "/leaf.svg", "rb"))
  local picture = svg:read "a"
  svg:close()
  lu.assertTrue(select(2, picture:gsub("<path", "")) > 20, "few veins are in the picture")
end

-- Without -o too: a file called after the script, where it is run.
function TestReadme:testTheScriptRunsByItself()
  local path = place(readme_script())
  local code, text = run(("cd %s && %s run %s"):format(quoted(folder), quoted(absolute(program)), quoted(path)))
  lu.assertEquals(code, 0, text)
  lu.assertStrMatches(output_of(("ls -A %s"):format(quoted(folder))), "readme%.%w+\nscripts")
end

-- "A 20-line script."
function TestReadme:testTheScriptIsShort()
  local _, lines = readme_script():gsub("\n", "\n")
  lu.assertTrue(lines + 1 <= 25, ("the README's script has %d lines"):format(lines + 1))
end
