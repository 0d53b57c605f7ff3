-- Free-ending veinlets, which Runions et al. 2005 leave open (section 7): when a closed network is done, finer sources within
-- its areoles draw open venation out of it. A veinlet that would cross a vein does not grow, so no loop is added.
local venule = ...

local options = require "venule.options"
local phase = require "venule.veinlet_phase"

local rows = {
  {"network", nil, type = "userdata", required = true, doc = "the veins that are there; veinlets are added to them"},
  {"domain", nil, type = "userdata", required = true, doc = "the blade, as it is now"},
  {"rng", nil, type = "userdata", required = true, doc = "the random numbers: venule.rng(seed)"},
  table.unpack(phase.rows),
}

--- Add veinlets that end freely within the areoles of a network. The sources that are left, and why others were given up.
local function veinlets(given)
  local o = options.read("veinlets", rows, given, 2)
  return phase.grow(o, 1, o.network, o.domain, o.rng)
end

return {veinlets = veinlets, veinlets_rows = rows}
