-- The strict reader for options of systems that are written in Lua: the same rules and the same words as the engine's
-- own. Rows: {name, default, type=, min=, max=, above=, required=, unit=, doc=}. A default of nil means "not given".
local venule = ...

local options = {}

local function names_of(rows)
  local names = {}
  for i, row in ipairs(rows) do names[i] = row[1] end
  return names
end

--- The end of an error about an unknown name: ", did you mean …?" where one is like it.
function options.suggestion(word, names)
  local closest = venule.closest(word, names)
  return closest and (', did you mean "%s"?'):format(closest) or ""
end

local function in_words(row)
  local unit = row.unit and row.unit ~= "" and " " .. row.unit or ""
  if row.above and row.max then return ("above %g%s and at most %g%s"):format(row.above, unit, row.max, unit) end
  if row.above then return ("above %g%s"):format(row.above, unit) end
  if row.min and row.max then return ("from %g to %g%s"):format(row.min, row.max, unit) end
  return row.min and ("at least %g%s"):format(row.min, unit) or ("at most %g%s"):format(row.max, unit)
end

--- Why a value does not fit its row, or nil. `what` names it.
function options.complaint(what, row, value)
  local wanted = row.type or math.type(row[2]) and "number" or type(row[2])
  local doc = row.doc and ": " .. row.doc or ""
  if wanted == "integer" and math.type(value) ~= "integer" then
    return ("%s: whole number expected, got %s%s"):format(what, tostring(value), doc)
  elseif wanted ~= "any" and wanted ~= "integer" and type(value) ~= wanted then
    return ("%s: %s expected, got %s%s"):format(what, wanted, type(value), doc)
  end
  if type(value) == "number" then
    local low = row.min and not (value >= row.min) or row.above and not (value > row.above)
    if value ~= value then return ("%s is not a number (NaN)%s"):format(what, doc) end
    if low or row.max and value > row.max then
      return ("%s = %g must be %s%s"):format(what, value, in_words(row), doc)
    end
  end
  if row.choices then
    for _, choice in ipairs(row.choices) do
      if choice == value then return nil end
    end
    return ('%s = "%s" must be one of %s%s'):format(what, value, table.concat(row.choices, ", "), doc)
  end
end

--- Read `given` by `rows`; errors carry the line `level` calls up, and begin with `name`.
function options.read(name, rows, given, level)
  level = (level or 1) + 1
  if type(given) ~= "table" then
    error(("%s: a table of options {…} expected, got %s"):format(name, type(given)), level)
  end
  local known, read = {}, {}
  for _, row in ipairs(rows) do
    known[row[1]] = row
    read[row[1]] = row[2]
  end
  local keys = {}
  for key in pairs(given) do keys[#keys + 1] = key end
  table.sort(keys, function(a, b) return tostring(a) < tostring(b) end) -- pairs() walks in an order of its own
  for _, key in ipairs(keys) do
    local value, row = given[key], known[key]
    if not row then
      error(('%s: unknown field "%s"%s'):format(name, tostring(key), options.suggestion(tostring(key), names_of(rows))), level)
    end
    local complaint = options.complaint(name .. "." .. key, row, value)
    if complaint then error(complaint, level) end
    read[key] = value
  end
  for _, row in ipairs(rows) do
    if row.required and given[row[1]] == nil then
      error(("%s: `%s` is missing: %s"):format(name, row[1], row.doc), level)
    end
  end
  return read
end

return options
