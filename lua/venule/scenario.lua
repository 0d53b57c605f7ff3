-- What a script and the program say to one another: parameters in, progress on the way, results out. From stock Lua there
-- is no program: parameters have their defaults, and results go to files called after the script.
local venule, host, set_manifest = ...

local options = require "venule.options"
host = host or {set = {}, outputs = {}, script = arg and arg[0]}

local scenario = {}
local parameters, parameter_rows = {}, {}

local row_fields = {
  {"min", nil, type = "number"}, {"max", nil, type = "number"}, {"choices", nil, type = "table"},
  {"unit", nil, type = "string"}, {"help", nil, type = "string"}, {"file", nil, type = "boolean"},
}

local function fail_usage(message)
  if host.fail_usage then host.fail_usage(message) end
  error(message, 0)
end

local from_text = {
  string = function(text) return text end,
  number = function(text) return tonumber(text) end,
  boolean = function(text) return ({["true"] = true, ["false"] = false})[text] end,
}

local function read_row(row)
  if type(row) ~= "table" or type(row[1]) ~= "string" or not from_text[type(row[2])] then
    error('param: a row is {"name", default, min=, max=, choices=, unit=, help=, file=}', 3)
  end
  local named = {}
  for key, value in pairs(row) do
    if key ~= 1 and key ~= 2 then named[key] = value end
  end
  local read = options.read("param." .. row[1], row_fields, named, 3)
  if read.choices then read.help = ("%s (%s)"):format(read.help or "one of", table.concat(read.choices, ", ")) end
  read[1], read[2], read.doc = row[1], row[2], row.help
  local complaint = options.complaint("param." .. row[1], read, row[2])
  if complaint then error(complaint .. " (its own default)", 3) end
  if read.choices then read.help = ("%s (one of %s)"):format(row.help or "", table.concat(read.choices, ", ")) end
  return read
end

-- A value of --set NAME=VALUE is of the type of the parameter's default.
local function value_from(row, given)
  local default = row[2]
  local value = given
  if type(given) == "string" then value = from_text[type(default)](given) end
  local what = "--set " .. row[1]
  if value == nil or type(value) ~= type(default) then
    fail_usage(('%s=%s: %s expected%s'):format(what, tostring(given), type(default), row.doc and ": " .. row.doc or ""))
  end
  if math.type(default) == "integer" and math.type(value) == "float" then
    value = math.tointeger(value) or value -- 5.0 means 5; 0.5 where 1 is the default is still a length
  end
  local complaint = options.complaint(what, row, value)
  if complaint then fail_usage(complaint) end
  return value
end

local function check_names(rows)
  local names, known = {}, {}
  for i, row in ipairs(rows) do names[i], known[row[1]] = row[1], true end
  for name in pairs(host.set) do
    if not known[name] then
      fail_usage(('--set %s: this script has no such parameter%s'):format(name, options.suggestion(name, names)))
    end
  end
end

local strict = {
  __index = function(_, key)
    local names = {}
    for i, row in ipairs(parameter_rows) do names[i] = row[1] end
    error(('param: no parameter "%s"%s'):format(tostring(key), options.suggestion(tostring(key), names)), 2)
  end,
}

--- Declare the script's parameters; a table of their values. `seed` is always there.
function scenario.param(rows)
  local read, has_seed = {}, false
  if type(rows) ~= "table" then error("param: a table of rows expected, got " .. type(rows), 2) end
  for i, row in ipairs(rows) do
    read[i] = read_row(row)
    has_seed = has_seed or row[1] == "seed"
  end
  if not has_seed then
    read[#read + 1] = {"seed", 1, type = "integer", doc = "which of all the pictures", help = "which of all the pictures"}
  end
  if host.help then host.show_help(read) end
  check_names(read)
  parameter_rows, parameters = read, {}
  for _, row in ipairs(read) do
    local given = host.set[row[1]]
    if given == nil then parameters[row[1]] = row[2] else parameters[row[1]] = value_from(row, given) end
  end
  local shown = {}
  for name, value in pairs(parameters) do shown[name] = value end
  return setmetatable(shown, strict)
end

--- Call once a step: shows progress, meets Ctrl-C and the limits. `fraction` (0 to 1) says how much is done.
function scenario.frame(fraction)
  if host.help then host.show_help({}) end
  if host.frame then host.frame(fraction) end
end

--- Say something about the run that the user should know, on stderr.
function scenario.note(text)
  if host.note then host.note(text) elseif io then io.stderr:write("note: ", text, "\n") end
end

local shortfall

--- Say that the results will be less than what was asked for: they are written, and then the run ends with this text and exit
--- status 3. nil takes it back.
function scenario.shortfall(text)
  shortfall = text
end

local told

--- Say, once, why the last `extend` added nothing although attractors are left.
function scenario.tell_stall()
  local why = venule.stalled()
  if why and why ~= told then venule.note(why) end
  told = why
end

local function as_json(value)
  if type(value) == "string" then
    return '"' .. value:gsub('[%c"\\]', function(c)
      return (c == '"' or c == "\\") and "\\" .. c or ("\\u%04x"):format(c:byte())
    end) .. '"'
  elseif math.type(value) == "float" then
    if value ~= value or value == math.huge or value == -math.huge then return "null" end
    local short = ("%.15g"):format(value)
    return ((tonumber(short) == value) and short or ("%.17g"):format(value)):gsub(",", ".") .. ""
  elseif type(value) ~= "table" then
    return tostring(value)
  end
  local keys, parts = {}, {}
  for key in pairs(value) do keys[#keys + 1] = key end
  table.sort(keys)
  for i, key in ipairs(keys) do parts[i] = as_json(key) .. ": " .. as_json(value[key]) end
  return "{" .. table.concat(parts, ", ") .. "}"
end

local function file_name(path)
  return path and path:match("[^/]+$") or nil
end

--- How the results were made: version, script and its hash, parameters. No clock, no machine: the same run, the same bytes.
local function manifest()
  return as_json {
    venule = venule.version,
    script = file_name(host.script),
    script_sha256 = host.script_sha256,
    parameters = parameters,
    seed = parameters.seed,
  }
end
set_manifest(manifest)

local result_rows = {
  {"network", nil, type = "userdata", doc = "the network that grew"},
  {"networks", nil, type = "table", doc = "several networks by name"},
  {"picture", nil, type = "any", doc = "a canvas, or function(canvas) … end that draws on one"},
  {"width", nil, type = "number", above = 0, unit = "pixels", doc = "of the canvas that picture is given"},
  {"height", nil, type = "number", above = 0, unit = "pixels", doc = "of the canvas that picture is given"},
  {"margin", nil, type = "number", min = 0, unit = "pixels", doc = "kept free around the view"},
  {"view", nil, type = "any", doc = "bounds of what it shows; left out: those of the networks"},
  {"background", nil, type = "string", doc = "of the canvas that picture is given"},
  {"camera", nil, type = "table", doc = "of the canvas that picture is given: how to look at space"},
  {"unit", nil, type = "string", doc = "length unit of the view; left out: the view's own, or the network's"},
}

-- The networks as a list, by name: what pairs() gives comes in another order in every run.
local function networks_of(r)
  if not r.networks then return r.network and {r.network} or {} end
  local names, list = {}, {}
  for name in pairs(r.networks) do names[#names + 1] = name end
  table.sort(names, function(a, b) return tostring(a) < tostring(b) end)
  for i, name in ipairs(names) do list[i] = r.networks[name] end
  return list
end

-- A straight line has room about it.
local function widen(min, max, dim)
  local size = 0
  for k = 1, dim do size = math.max(size, max[k] - min[k]) end
  local pad = size > 0 and size / 20 or 1
  for k = 1, dim do
    if max[k] == min[k] then min[k], max[k] = min[k] - pad, max[k] + pad end
  end
end

local function extent_of(networks, dim)
  local min, max
  for _, network in ipairs(networks) do
    local extent = network:measure().extent
    min, max = min or {table.unpack(extent.min)}, max or {table.unpack(extent.max)}
    for k = 1, dim do
      min[k], max[k] = math.min(min[k] or 0, extent.min[k] or 0), math.max(max[k] or 0, extent.max[k] or 0)
    end
  end
  if not min then return nil end
  widen(min, max, dim)
  return {min = {table.unpack(min, 1, dim)}, max = {table.unpack(max, 1, dim)}}
end

-- What a page can be measured in. A network may count in cells or pixels: then its picture has no true scale.
local paper_units = {mm = true, cm = true, m = true, um = true, ["in"] = true, pt = true}

-- Pages are at true scale when anybody named such a unit: the view, or else a network.
local function unit_of(r, view)
  local network = networks_of(r)[1]
  if view and view.unit or not network or not paper_units[network.unit] then return nil end
  return network.unit
end

local function draw(r)
  if type(r.picture) == "userdata" then return r.picture end
  local view = r.view or extent_of(networks_of(r), r.camera and 3 or 2)
  local canvas = venule.canvas {
    width = r.width, height = r.height, margin = r.margin, view = view, background = r.background, unit = r.unit or unit_of(r, view),
    camera = r.camera,
  }
  if r.picture then
    r.picture(canvas)
  else
    for _, network in ipairs(networks_of(r)) do
      local thin = network:measure().max_radius == 0 and 1 / canvas.scale or "radius" -- one pixel where radii are not known
      canvas:stroke(network, {width = thin})
    end
  end
  return canvas
end

local pictures = {png = true, svg = true, pdf = true, eps = true}
local network_formats = venule.formats()

local function default_outputs(r)
  local stem = (file_name(host.script) or "venule"):gsub("%.lua$", "")
  return {stem .. (r.picture and ".png" or ".json")}
end

local function extension_of(path)
  return (path:match("%.(%w+)$") or ""):lower()
end

local is_network_format = {}
for _, format in ipairs(network_formats) do is_network_format[format] = true end

-- Before the run begins: nobody waits an hour to hear that a file cannot be of that kind.
for _, path in ipairs(host.outputs) do
  if not pictures[extension_of(path)] and not is_network_format[extension_of(path)] then
    fail_usage(("-o %s: unknown extension; known are .png, .svg, .pdf, .eps, and for networks .%s"):format(path,
      table.concat(network_formats, ", .")))
  end
end

local function check_networks(r)
  for _, network in ipairs(networks_of(r)) do
    local class = type(network) == "userdata" and getmetatable(network).__name or type(network)
    if class ~= "venule.network" then
      error(("result.%s: networks expected, got %s"):format(r.networks and "networks" or "network", class), 3)
    end
  end
end

-- Before any is written: a run that must fail leaves no file behind.
local function check_outputs(r, outputs)
  for _, path in ipairs(outputs) do
    if is_network_format[extension_of(path)] then
      if not r.network and not r.networks then fail_usage(("-o %s: the script gives no network to save"):format(path)) end
      local can, why = venule.can_save(path, r.network or r.networks)
      if not can then fail_usage("-o " .. why) end
    end
  end
end

local function summary(r)
  local total = {nodes = 0, tips = 0, length = 0}
  for _, network in ipairs(networks_of(r)) do
    local measures = network:measure()
    for key in pairs(total) do total[key] = total[key] + measures[key] end
  end
  return total
end

--- Hand over the results: each -o is written by its extension; without one, a file called after the script.
function scenario.result(given)
  local r = options.read("result", result_rows, given, 2)
  local kind = type(r.picture)
  if r.picture and kind ~= "userdata" and kind ~= "function" then
    error("result.picture: a canvas or a function expected, got " .. kind, 2)
  end
  check_networks(r)
  if host.help then host.show_help({}) end
  scenario.tell_stall()
  local outputs = #host.outputs > 0 and host.outputs or default_outputs(r)
  check_outputs(r, outputs)
  local canvas
  for _, path in ipairs(outputs) do
    if pictures[extension_of(path)] then
      canvas = canvas or draw(r)
      canvas:save(path)
    else
      venule.save(path, r.network or r.networks)
    end
  end
  if host.finish then
    host.finish(outputs, summary(r))
  else
    print(table.concat(outputs, "\n"))
  end
  if shortfall then
    if host.fail_infeasible then host.fail_infeasible(shortfall) end
    error(shortfall, 0)
  end
end

scenario.result_rows = result_rows

return scenario
