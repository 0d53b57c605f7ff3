-- Growing veinlets, for venule.veinlets and for the last phase of venule.venation: its options, and how.
local venule = ...

local rows = {
  {"birth_distance", nil, type = "number", above = 0, unit = "length", required = true, doc = "how far the veinlets' sources keep from each other: smaller means more veinlets to an areole"},
  {"vein_distance", nil, type = "number", above = 0, unit = "length", doc = "and from veins: an areole narrower than twice that gets none; left out: half of birth_distance"},
  {"kill_distance", nil, type = "number", above = 0, unit = "length", doc = "a veinlet ends this far from its source; left out: segment_length"},
  {"segment_length", nil, type = "number", above = 0, unit = "length", doc = "D of the veinlets; left out: a quarter of birth_distance"},
  {"darts", nil, type = "number", above = 0, unit = "darts/length²", doc = "how many sources are tried by area, five times; left out: 20 by birth_distance²"},
}

local lengths = {"birth_distance", "vein_distance", "segment_length", "kill_distance"}

-- What is left out, and lengths times the unit of the blade.
local function complete(o, unit)
  o.vein_distance = o.vein_distance or o.birth_distance / 2
  o.segment_length = o.segment_length or o.birth_distance / 4
  o.kill_distance = o.kill_distance or o.segment_length
  o.darts = (o.darts or 20 / o.birth_distance ^ 2) / unit ^ 2
  for _, name in ipairs(lengths) do o[name] = o[name] * unit end
  return o
end

local function reach(o, net, auxin, domain)
  repeat
    local added = net:extend(auxin:influence(net), {length = o.segment_length, domain = domain, meet = "stop"})
    auxin:consume(net, {distance = o.kill_distance})
    venule.frame()
  until added == 0
end

-- Sources far from veins come first: a veinlet grows into the middle of its areole, and later ones may branch off it.
local ROUNDS = {4, 2.8, 2, 1.4, 1}

-- The sources that are left.
local function grow(given, unit, net, domain, rng)
  local o, auxin = complete(given, unit), venule.attractors {}
  for _, far in ipairs(ROUNDS) do
    auxin:throw {
      domain = domain, density = o.darts, spacing = o.birth_distance, clearance = far * o.vein_distance, network = net, rng = rng,
    }
    reach(o, net, auxin, domain)
  end
  return auxin
end

return {rows = rows, grow = grow}
