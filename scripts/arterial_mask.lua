-- An arterial tree in a mask: what is bright in a picture, or marked in a volume of voxels (OpenCCO's -d).
--   venule run scripts/arterial_mask.lua --set mask=organ.png -o tree.png       (.png, .pgm: 2D)
--   venule run scripts/arterial_mask.lua --set mask=liver.nii.gz -o tree.png    (.nii, .nii.gz, .nrrd, .vol: 3D, in the file's own mm)
-- A vessel goes round a bay of the outline, never across it.
local venule = require "venule"

local p = venule.param {
  {"mask", "", file = true, help = "a picture or a volume"},
  {"terminals", 1000, min = 1, max = 10000000, help = "ends of the tree"},
  {"perfusion", 20000.0, min = 1e-3, max = 1e9, unit = "mm²", help = "area that a picture's mask is to have; a volume has its own size"},
  {"inflow", 500.0, min = 1e-6, max = 1e6, unit = "mL/min", help = "into the root, once the tree is whole"},
  {"exponent", 3.0, min = 1, max = 100, help = "γ: r^γ adds up where vessels part"},
  {"viscosity", 3.6e-3, min = 1e-6, max = 10, unit = "Pa·s", help = "of the blood"},
  {"border_distance", 0.0, min = 0, max = 1000, unit = "mm", help = "that vessels keep from the border"},
  {"root", "", help = "x,y or x,y,z in mm; left out: the border's point nearest to the middle, where organs are hollow"},
  {"component", "one", choices = {"one", "largest", "all"}, help = "what of a mask in several parts"},
  {"size", 1400, min = 50, max = 16000, unit = "pixels", help = "width of the picture"},
}
if p.mask == "" then error("say which mask: --set mask=FILE (.png, .pgm, .nii, .nii.gz, .nrrd, .vol)", 0) end

-- Pictures do not know how large a pixel is: the mask's area says it.
local function organ_of(path)
  if not path:lower():find "%.p[ng][gm]$" then return venule.domain.volume(path, {component = p.component}) end
  local pixels = venule.domain.image(path, {component = p.component}):measure()
  return venule.domain.image(path, {component = p.component, pixel = math.sqrt(p.perfusion / pixels)})
end

local organ = organ_of(p.mask)
local bounds, root = organ:bounds(), {}
for number in p.root:gmatch "[^,%s]+" do root[#root + 1] = tonumber(number) end
if #root == 0 then
  for k = 1, organ.dim do root[k] = (bounds.min[k] + bounds.max[k]) / 2 end
  root = {organ:closest(table.unpack(root))}
end

local tree = venule.cco {
  domain = organ, root = root, terminals = p.terminals, inflow = p.inflow * 1000 / 60, exponent = p.exponent,
  viscosity = p.viscosity, border_distance = p.border_distance, seed = p.seed,
}
tree:run {progress = true}

venule.result {
  network = tree.network, view = bounds, width = p.size, background = "#ffffff",
  margin = p.size / 40, camera = organ.dim == 3 and {fog = 0.5, zoom = 1.3} or nil,
  picture = function(page)
    if organ.dim == 2 then page:fill(organ, {color = "#fdf3ef", stroke = "#b08a80"}) end
    page:stroke(tree.network, {color = "#b3201c", min_width = 0.5})
  end,
}
