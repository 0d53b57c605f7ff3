-- What the reference page and the editor stubs say of the functions that are written in Lua.
local venule = ...

local functions = {
  {name = "param", owner = "venule", arguments = "rows", types = {rows = "table[]"}, returns = "table", doc =
    'Declare the script\'s parameters and get their values: rows {"name", default, min=, max=, choices=, unit=, help=, file=}. '
    .. "`--set name=value` changes one; `seed` is always there."},
  {name = "frame", owner = "venule", arguments = "fraction", types = {["fraction?"] = "number"}, doc =
    "Call once a step: shows progress on a terminal, and meets Ctrl-C and the limits."},
  {name = "note", owner = "venule", arguments = "text", types = {text = "string"}, doc =
    "Say something about the run that the user should know, on stderr."},
  {name = "tell_stall", owner = "venule", arguments = "", types = {}, doc =
    "Say on stderr, once, why the last `extend` added nothing although attractors are left; `result` and `run` do it too."},
  {name = "shortfall", owner = "venule", arguments = "text", types = {["text?"] = "string"}, doc =
    "Say that the results will be less than what was asked for: `result` writes them, and then the run ends with this text and exit "
    .. "status 3. nil takes it back. `run` of venule.cco{…} says it of an organ that is full too early."},
  {name = "result", owner = "venule", arguments = "options", types = {options = "venule.result.Options"}, rows = "result", doc =
    "Hand over what came out: each `-o` is written by its extension (.svg, .png, .pdf, .eps: the picture; .json: the networks); "
    .. "without one, a file called after the script."},
  {name = "venation", owner = "venule", arguments = "options", types = {options = "venule.venation.Options"}, rows = "venation",
    returns = "venule.Venation", doc =
    "Open leaf venation (Runions §3), ready to grow: `s:step()` (false when done), `s:run{progress=}`, `s.network`, "
    .. "`s.attractors`. The loop is plain Lua in lua/venule/venation.lua; copy it when an option is not enough."},
  {name = "veinlets", owner = "venule", arguments = "options", types = {options = "venule.veinlets.Options"}, rows = "veinlets",
    returns = "venule.Attractors", doc =
    "Add open venation by finer sources to a network that is there: veinlets that end freely within its areoles. None crosses or joins "
    .. "a vein, so that the areoles stay as they are. What comes back are the sources: those that are left, and why others were given up."},
  {name = "brochidodromous", owner = "venule", arguments = "options", types = {options = "venule.brochidodromous.Options"},
    rows = "brochidodromous", returns = "{network: venule.Network, arches: integer}", doc =
    "A midvein and secondaries that are joined in arches within the margin (Ficus, Eucalyptus), as a network to go on from: "
    .. "scripts/brochidodromous.lua fills it by venule.venation."},
  {name = "cco", owner = "venule", arguments = "options", types = {options = "venule.cco.Options"}, rows = "cco",
    returns = "venule.CcoSystem", doc =
    "Arterial trees by constrained constructive optimisation (Kerautret et al. 2023), ready to grow. `s:run{progress=}` grows to the end: "
    .. "s, or where the domain is full before, false and why; `s:step()` adds a terminal to each tree, false when done; `s:grow(n)` adds up "
    .. "to n, and gives how many came in all. `s.network` is the tree as it is now, with radius, flow and pressure; of several trees, "
    .. "`s.networks` has all by name, and so has `s.arteries`; `s.report`, `s.volume`, `s.fraction`, `s.done`, `s.domain`. Units are mm, "
    .. "Pa, mm³/s and Pa·s; 1 mmHg is 133.322 Pa, 1 mL/min is 1000 / 60 mm³/s. What a tree of `trees` and a stage may say is below."},
  {name = "vessels", owner = "venule", arguments = "options", types = {options = "venule.vessels.Options"}, rows = "vessels",
    returns = "venule.VesselsSystem", doc =
    "Arteries and veins that grow together (Rauch & Harders 2021), ready to grow: `s:run{progress=}`, `s:step()` (false when done), "
    .. "`s.arteries`, `s.veins`, both by name in `s.networks`, `s.drains`, `s.sources`, `s.tissue`, `s.unit`. Lengths are those at the size that the "
    .. "tissue has at first; left out, they are parts of the domain's longest side. What `arteries`, `veins` and a stage may say is below. "
    .. "The loop is plain Lua in lua/venule/vessels.lua; copy it when an option is not enough."},
  {name = "plot", owner = "venule", arguments = "options", types = {options = "venule.plot.Options"}, rows = "plot",
    returns = "venule.Canvas", doc =
    "Numbers as a figure, on a canvas to save or draw on: lines and dots, deviations as bars or bands, plain or logarithmic axes. "
    .. "A legend stands where it covers nothing. What an axis and a series may say is below."},
}

local leaf_functions = {
  {name = "leaf.outline", arguments = "shape, options", types = {shape = "string", ["options?"] = "table"}, returns = "number[][]", doc =
    "The points {{x, y}, …} of a shape's outline, counterclockwise from the petiole: `venule.leaf.outline(\"fan\", {notch = 0})`."},
  {name = "leaf.teeth", arguments = "points, waves", types = {points = "number[][]", waves = "number[][]"}, returns = "number[][]", doc =
    "Teeth upon an outline whose first point is the petiole and whose highest is the tip: sums of triangular waves {{count, depth, skew}, …} "
    .. "(Runions §3.2). `count` teeth at each side, `depth` of the outline's length, `skew` (0.5) where a tooth is highest. Where the "
    .. "petiole saw the whole margin it still does: what a tooth would hide is cut off. Another outline may come to cross itself."},
  {name = "leaf.base", arguments = "blade, n", types = {blade = "venule.Domain|venule.Growth", n = "integer"}, returns = "number[][]", doc =
    "n seed points {{x, y}, …} just inside the blade: evenly along its base, for parallel veins; where the blade hangs below its "
    .. "petiole, on a small arc about that."},
}

local function range_of(row)
  if row.above then return ("above %g"):format(row.above) end
  if row.min and row.max then return ("%g to %g"):format(row.min, row.max) end
  return row.min and ("%g or more"):format(row.min) or ""
end

local function type_of(row)
  if row.choices then return '"' .. table.concat(row.choices, '"|"') .. '"' end
  local name = row.type or math.type(row[2]) and "number" or type(row[2])
  return name == "userdata" and "any" or name
end

local function in_braces(value)
  if type(value) ~= "table" then return tostring(value) end
  local parts = {}
  for i, item in ipairs(value) do parts[i] = in_braces(item) end
  return "{" .. table.concat(parts, ", ") .. "}"
end

local stubs, page = {}, {}

local function write_rows(name, rows)
  stubs[#stubs + 1] = ("---@class (exact) venule.%s.Options\n"):format(name)
  page[#page + 1] = "\n| option | type | default | range | unit | |\n|---|---|---|---|---|---|\n"
  for _, row in ipairs(rows) do
    local default = row[2] == nil and "" or type(row[2]) == "table" and in_braces(row[2])
      or (type(row[2]) == "string" and '"%s"' or "%s"):format(tostring(row[2]))
    stubs[#stubs + 1] = ("---@field %s%s %s # %s\n"):format(row[1], row.required and "" or "?", type_of(row), row.doc)
    page[#page + 1] = ("| `%s` | %s | %s | %s | %s | %s |\n"):format(row[1], (type_of(row):gsub("|", " or ")),
      row.required and "required" or default, range_of(row), row.unit or "", row.doc)
  end
  stubs[#stubs + 1] = "\n"
end

local function write_function(f)
  page[#page + 1] = ("\n### `venule.%s%s`\n\n%s\n"):format(f.name, f.rows and "{…}" or "(" .. f.arguments .. ")", f.doc)
  if f.rows then write_rows(f.rows, f.list or venule[f.rows .. "_rows"]) end
  stubs[#stubs + 1] = "---" .. f.doc .. "\n"
  for name in f.arguments:gmatch "%w+" do
    local optional = f.types[name] and "" or "?"
    stubs[#stubs + 1] = ("---@param %s%s %s\n"):format(name, optional, f.types[name .. optional])
  end
  if f.returns then stubs[#stubs + 1] = "---@return " .. f.returns .. "\n" end
  stubs[#stubs + 1] = ("function venule.%s(%s) end\n\n"):format(f.name, f.arguments)
end

for _, f in ipairs(functions) do write_function(f) end

for _, part in ipairs {
  {"A tree of venule.cco, one of `trees`", "cco.tree", venule.cco_branch_rows},
  {"A stage of venule.cco, one of `stages`", "cco.stage", venule.cco_stage_rows},
  {"Arteries or veins of venule.vessels", "vessels.tree", venule.vessels_branch_rows},
  {"A stage of venule.vessels, one of `stages`", "vessels.stage", venule.vessels_stage_rows},
  {"An axis of a plot", "plot.axis", venule.plot_axis_rows},
  {"A series of a plot", "plot.series", venule.plot_series_rows},
} do
  page[#page + 1] = ("\n%s:\n"):format(part[1])
  write_rows(part[2], part[3])
end

page[#page + 1] = "\n## venule.leaf\n\nBlades with their petiole at (0, 0) and their tip at (0, length). All but `lobed` are "
  .. "star-shaped about the petiole: `venule.growth.marginal {domain = …, origin = {0, 0}}` takes them.\n"
for _, name in ipairs(venule.leaf_names) do
  local found = venule.leaf_shapes[name]
  write_function {
    name = "leaf." .. name, arguments = "options", types = {["options?"] = ("venule.leaf.%s.Options"):format(name)},
    rows = "leaf." .. name, list = found.rows, returns = "venule.Domain", doc = found.doc,
  }
end
for _, f in ipairs(leaf_functions) do write_function(f) end

stubs[#stubs + 1] = [[
---@class venule.CcoReport
---@field terminals integer
---@field wanted integer # of the stage that is under way
---@field volume number # Σ π r² ℓ
---@field inflow number
---@field darts integer # tries for terminals
---@field begun_anew integer # times that a small tree stood in its own way
---@field redrawn integer # terminals that could not be connected
---@field tried integer # candidates whose volume was computed
---@field collapsed integer # whose bifurcation point ran into an end
---@field short_segments integer # shorter than thick
---@field outside integer # that left the domain
---@field crossing integer # that met another vessel
---@field crowding integer # that would have made an older vessel too thick for its place
---@field asymmetric integer

---@class venule.CcoSystem
---@field network venule.Network # of a single tree
---@field networks table<string, venule.Network>
---@field report venule.CcoReport|table<string, venule.CcoReport> # of a single tree, or by name
---@field volume number # of all trees
---@field fraction number # how much has grown, 0 to 1
---@field done boolean
---@field domain venule.Domain
---@field engine venule.Cco
---@field [string] venule.Network # each tree by its name
local CcoSystem = {}

---Add up to n terminals to each tree; how many came in all. Where there is no place for another: nil, why, how many came before.
---@param n integer
---@return integer? added
---@return string? why
---@return integer? before
function CcoSystem:grow(n) end

---Add a terminal to each tree; false when done, or false and why.
---@return boolean more
---@return string? why
function CcoSystem:step() end

---Grow to the end; false and why where the domain is full before.
---@param options? {progress?: boolean|fun(system: venule.CcoSystem)}
---@return venule.CcoSystem|false
---@return string? why
function CcoSystem:run(options) end

---@class venule.VesselsSystem
---@field arteries venule.Network
---@field veins? venule.Network
---@field networks table<string, venule.Network> # both, by name
---@field drains venule.Attractors # oxygen drains, which arteries grow toward
---@field sources venule.Attractors # of carbon dioxide, which veins grow toward
---@field tissue venule.Domain|venule.Growth # where
---@field unit number # today's unit of length, in the coordinates of the simulation: 1 at first, smaller as the tissue grows
---@field time integer # steps taken
---@field steps integer # of all stages
---@field stage integer # which is under way
local VesselsSystem = {}

---Grow by one step; false when done.
---@return boolean
function VesselsSystem:step() end

---Grow to the end.
---@param options? {progress?: boolean|fun(system: venule.VesselsSystem)}
---@return venule.VesselsSystem
function VesselsSystem:run(options) end

---@class venule.Venation
---@field network venule.Network
---@field attractors venule.Attractors
local Venation = {}

---Grow by one step; false when done.
---@return boolean
function Venation:step() end

---Grow to the end.
---@param options? {progress?: boolean|fun(system: venule.Venation)}
---@return venule.Venation
function Venation:run(options) end

]]

return {stubs = table.concat(stubs), page = table.concat(page)}
