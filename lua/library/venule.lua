---@meta venule
-- Generated from the bindings (the target `generate`); not to be edited.

---@class venule
---@field version string
local venule = {domain = {}, growth = {}, leaf = {}}

---@class venule.Bounds
---@field min number[]
---@field max number[]
---@field unit? string

---@class venule.Measures
---@field nodes integer
---@field roots integer
---@field tips integer
---@field bifurcations integer
---@field joins integer
---@field depth integer
---@field length number
---@field min_radius number
---@field max_radius number
---@field extent venule.Bounds
---@field leaf? venule.LeafMeasures

---@class venule.Statistics
---@field count integer
---@field mean number
---@field deviation number
---@field min number
---@field lower number
---@field median number
---@field upper number
---@field max number

---@class venule.LeafMeasures
---@field area number
---@field area_of "domain"|"hull"
---@field length number
---@field density number # length by area
---@field order_density number[] # of each vein order
---@field tips integer # free ends but for roots
---@field tip_density number
---@field free_ends integer # tips within areoles
---@field free_end_density number
---@field degree3 integer # junctions of three edges
---@field degree4 integer
---@field degree_more integer
---@field loops integer # edges - nodes + connected parts
---@field crossings integer # where there are any, areoles say little
---@field areoles integer
---@field areole_areas number[]
---@field areole_quotients number[] # 4 π area / perimeter²
---@field areole_area venule.Statistics
---@field areole_quotient venule.Statistics
---@field hierarchy {merges: integer, height: integer, strahler: integer, asymmetry: number, nesting: number}
---@field angles {count: integer, daughters: number, bins: {from: number, to: number, count: integer, thick_middle: number, thick_thin: number, middle_thin: number}[]}
---@field distance {resolution: number, points: integer, mean: number, max: number, mode: number}

---@class venule.FlowWorst
---@field error number # relative
---@field node? integer # where: the node, or the node whose edge it is
---@field join? integer # or the join

---@class venule.FlowReport
---@field inflow number # at all roots, length³/s
---@field outflow number # at all terminals, length³/s
---@field volume number # Σ π r² ℓ, length³
---@field resistance number # power / inflow², Pa s/length³
---@field power number # Σ R Q², Pa length³/s
---@field conservation venule.FlowWorst # in less out, by what passes a node
---@field drop venule.FlowWorst # loss along an edge less Poiseuille's, by the span of pressures
---@field terminal venule.FlowWorst # pressure less pressure_out, by it
---@field terminal_pressure venule.Statistics # Pa
---@field terminal_flow venule.Statistics # length³/s
---@field wall_shear venule.Statistics # of edges, 4 μ |Q| / (π r³), Pa
---@field murray venule.Statistics # |r_parent^exponent - Σ r_child^exponent| / r_parent^exponent at forks
---@field fitted venule.Statistics # the exponents that make it 0
---@field terminals {node: integer[], pressure: number[], flow: number[]}
---@field edge_shear number[] # Pa, of each node's edge; 0 at a root
---@field join_shear number[] # Pa, of each join

---@class venule.Spread
---@field mean number
---@field deviation number

---@class venule.Level
---@field level integer # forks between the root and it
---@field count integer # segments
---@field diameter venule.Spread
---@field length venule.Spread
---@field flow? venule.Spread # where flows are known

---@class venule.Levels
---@field [integer] venule.Level
---@field segments integer
---@field symmetry venule.Statistics # thinnest daughter's radius by the thickest's
---@field slenderness venule.Statistics # length by diameter
---@field angle venule.Statistics # degrees, between two daughters

---@class venule.VesselParts
---@field count integer
---@field diameter venule.Spread
---@field length venule.Spread

---@class venule.OrderRatio
---@field ratio number # 0 with fewer than two orders
---@field r2 number

---@class venule.ForkBin
---@field from number # r2/r1
---@field to number
---@field count integer
---@field ratio? number # mean; this and the following where count > 0
---@field between? venule.Spread
---@field thick? venule.Spread
---@field thin? venule.Spread
---@field theory? {between: number, thick: number, thin: number} # Murray's, at the mean ratio

---@class venule.MurrayResidual: venule.Statistics
---@field rms number
---@field worst? integer # the node of the largest

---@class venule.VesselMeasures
---@field exponent number # that `murray` is of
---@field murray venule.MurrayResidual # |r_parent^exponent - Σ r_child^exponent| / r_parent^exponent
---@field fitted venule.Statistics # the exponents that make it 0
---@field bifurcations integer # nodes with a parent and two children
---@field furcations integer # nodes with three children or more
---@field ratio venule.Statistics # r2/r1
---@field expansion venule.Statistics # (r1² + r2²) / r0²
---@field angles {between: venule.Statistics, thick: venule.Statistics, thin: venule.Statistics, bins: venule.ForkBin[]} # degrees
---@field orders {segments: venule.VesselParts, elements: venule.VesselParts}[]
---@field segments integer
---@field elements integer
---@field bifurcation_ratio venule.OrderRatio # by how much there are fewer elements an order up
---@field diameter_ratio venule.OrderRatio # and they are thicker
---@field length_ratio venule.OrderRatio # and longer
---@field tortuosity {segments: venule.Statistics, elements: venule.Statistics} # arc by chord
---@field curvature {segments: venule.Statistics, elements: venule.Statistics} # mean square, radians²/length²

---@class venule.Boxes
---@field dimension number
---@field r2 number # of the line
---@field extent number
---@field boxes {side: number, count: integer}[] # from the largest

---@class venule.Tissue
---@field resolution number
---@field points integer
---@field distance venule.Statistics
---@field furthest number[] # where distance.max is
---@field mode number
---@field lumen number # share of points inside vessels
---@field perfused? number # share within reach
---@field bin number # width of a bin
---@field histogram integer[] # points

---@class (exact) venule.network.Options
---@field dim? integer # dimensions: 2 or 3 (default 2)
---@field max_nodes? integer # a network that would grow beyond it fails; guards against a script that runs away, nodes (default 1e+08)
---@field unit? string # the script's length unit ("mm"), carried into files (default "")
---@field murray? any # radii by Murray's law, kept up to date as the network grows

---An empty network.
---@param options venule.network.Options
---@return venule.Network
function venule.network(options) end

---Read a network from a file, by its extension; or, where it holds several (.json), a table of them by name.
---@param path string
---@return venule.Network|table<string, venule.Network>
function venule.load(path) end

---Write one network, or several by name (.json), by the extension.
---@param path string
---@param networks venule.Network|table<string, venule.Network>
function venule.save(path, networks) end

---Whether a file of that name can hold them; if not, why.
---@param path string
---@param networks venule.Network|table<string, venule.Network>
---@return boolean, string?
function venule.can_save(path, networks) end

---The extensions that networks are written and read by.
---@return string[]
function venule.formats() end

---@class (exact) venule.attractors.Options
---@field dim? integer # dimensions: 2 or 3 (default 2)
---@field seed? integer # decides which of equally near nodes an attractor influences (default 0)

---An empty set of attractors.
---@param options venule.attractors.Options
---@return venule.Attractors
function venule.attractors(options) end

---@class (exact) venule.canvas.Options
---@field width? number # width of the picture; left out: from the height and the view's proportions, or 800, pixels
---@field height? number # height of the picture; left out: from the width and the view's proportions, or 800, pixels
---@field view? any # what is fitted, centred, into the canvas; without it, 1 pixel is 1 unit and (0, 0) the lower left corner, length
---@field margin? number # kept free around the view, pixels (default 10)
---@field background? string # a colour, or "none" (default "none")
---@field unit? string # length unit of the view: "mm", "cm", "m", "um", "in" or "pt"; pages (SVG, PDF) are then at true scale; "": 96 pixels an inch (default "")
---@field camera? any # how to look at space: the eye, what it looks at and what is up (each has a good default), the angle that is seen in degrees (0: a parallel projection), and how much what is far fades (0 to 1); without it, from straight above

---An empty picture.
---@param options venule.canvas.Options
---@return venule.Canvas
function venule.canvas(options) end

---How long a line of text is at a size in pixels.
---@param text string
---@param size number
---@return number
function venule.text_width(text, size) end

---@class (exact) venule.voxels.Options
---@field network? venule.Network # what becomes voxels
---@field networks? any # several networks of one unit
---@field content? "mask"|"label"|"tree"|"order"|"segment"|"radius"|"centerline"|"vesselness" # what a voxel says: whether there is a vessel, of which network, tree, vein order or branch (the node at its far end), of which radius; whether it is on the centre line; which part of it vessels fill (default "mask")
---@field resolution? number # side of a voxel, length
---@field size? integer # along the longest side, in place of a resolution; left out: 128, voxels
---@field margin? integer # kept free on all sides; left out: 1, or 0 around bounds that are given, voxels
---@field bounds? any # what the volume covers, where vessels are cut; left out: all vessels, length

---Make voxels of one network or of several: cubes, or squares in 2D. What hangs together in a network hangs together in voxels, however thin it is; where tubes overlap, the one that a voxel lies deepest in has it. `networks` by name are numbered by alphabet: arteries 1, veins 2.
---@param options venule.voxels.Options
---@return venule.Volume
function venule.voxels(options) end

---Random numbers that depend on nothing but the seed.
---@param seed integer
---@return venule.Rng
function venule.rng(seed) end

---0 below `low`, 1 above `high`, and a smooth rise between.
---@param low number
---@param high number
---@param t number
---@return number
function venule.smoothstep(low, high, t) end

---Why the last `extend` added nothing although attractors are left, or nil. `venule.result` says it on stderr.
---@return string?
function venule.stalled() end

---Which of the names a mistyped word most likely means, or nil.
---@param word string
---@param names string[]
---@return string?
function venule.closest(word, names) end

---Declare the script's parameters and get their values: rows {"name", default, min=, max=, choices=, unit=, help=, file=}. `--set name=value` changes one; `seed` is always there.
---@param rows table[]
---@return table
function venule.param(rows) end

---Call once a step: shows progress on a terminal, and meets Ctrl-C and the limits.
---@param fraction? number
function venule.frame(fraction) end

---Say something about the run that the user should know, on stderr.
---@param text string
function venule.note(text) end

---Say on stderr, once, why the last `extend` added nothing although attractors are left; `result` and `run` do it too.
function venule.tell_stall() end

---Say that the results will be less than what was asked for: `result` writes them, and then the run ends with this text and exit status 3. nil takes it back. `run` of venule.cco{…} says it of an organ that is full too early.
---@param text? string
function venule.shortfall(text) end

---@class (exact) venule.result.Options
---@field network? any # the network that grew
---@field networks? table # several networks by name
---@field picture? any # a canvas, or function(canvas) … end that draws on one
---@field width? number # of the canvas that picture is given
---@field height? number # of the canvas that picture is given
---@field margin? number # kept free around the view
---@field view? any # bounds of what it shows; left out: those of the networks
---@field background? string # of the canvas that picture is given
---@field camera? table # of the canvas that picture is given: how to look at space
---@field unit? string # length unit of the view; left out: the view's own, or the network's

---Hand over what came out: each `-o` is written by its extension (.svg, .png, .pdf, .eps: the picture; .json: the networks); without one, a file called after the script.
---@param options venule.result.Options
function venule.result(options) end

---@class (exact) venule.venation.Options
---@field domain any # a blade that grows (venule.growth), or a domain that stays
---@field rng any # the random numbers: venule.rng(seed)
---@field roots? table # seed points {{x, y}, …}; left out: the lowest point of the blade
---@field network? any # a network to go on from, in place of roots
---@field birth_distance? number # b_s: a new source keeps this far from other sources
---@field vein_distance? number # b_v: and this far from veins; left out: birth_distance
---@field kill_distance? number # d_k: a vein this close consumes its source
---@field segment_length? number # D: the length a vein gains in a step
---@field attraction_distance? number # sources farther than this draw no vein; left out: any distance
---@field darts number # ρ: darts thrown per area and step; under marginal growth, per area once
---@field neighborhood? "nearest"|"relative"|"urquhart" # which nodes a source draws: the nearest one (open venation), its relative neighbors (closed venation), or the Urquhart approximation of these
---@field vein_steps? integer # vein steps to one growth step; left out: as many as keep pace with the tip
---@field stop? "reached"|"grown" # end when every source is reached, or as soon as the blade is grown
---@field veinlets? table # {birth_distance=, …}, as in venule.veinlets{…}: when all is done, veinlets that end freely
---@field murray? table # {exponent=, tip_radius=}: radii by Murray's law
---@field unit? string # length unit that files carry

---Open leaf venation (Runions §3), ready to grow: `s:step()` (false when done), `s:run{progress=}`, `s.network`, `s.attractors`. The loop is plain Lua in lua/venule/venation.lua; copy it when an option is not enough.
---@param options venule.venation.Options
---@return venule.Venation
function venule.venation(options) end

---@class (exact) venule.veinlets.Options
---@field network any # the veins that are there; veinlets are added to them
---@field domain any # the blade, as it is now
---@field rng any # the random numbers: venule.rng(seed)
---@field birth_distance number # how far the veinlets' sources keep from each other: smaller means more veinlets to an areole
---@field vein_distance? number # and from veins: an areole narrower than twice that gets none; left out: half of birth_distance
---@field kill_distance? number # a veinlet ends this far from its source; left out: segment_length
---@field segment_length? number # D of the veinlets; left out: a quarter of birth_distance
---@field darts? number # how many sources are tried by area, five times; left out: 20 by birth_distance²

---Add open venation by finer sources to a network that is there: veinlets that end freely within its areoles. None crosses or joins a vein, so that the areoles stay as they are. What comes back are the sources: those that are left, and why others were given up.
---@param options venule.veinlets.Options
---@return venule.Attractors
function venule.veinlets(options) end

---@class (exact) venule.brochidodromous.Options
---@field domain any # the blade: its petiole at `root`, its tip above that
---@field rng any # the random numbers: venule.rng(seed)
---@field root? table # where the midvein starts: {x, y}
---@field secondaries? integer # at each side
---@field rise? number # how far the longest ones climb toward the tip, of the blade's length
---@field reach? number # how near the margin arches come, of the way from the midvein
---@field irregularity? number # of the places of secondaries, in shares of the gap between them
---@field segment_length? number # D: the length a vein gains in a step

---A midvein and secondaries that are joined in arches within the margin (Ficus, Eucalyptus), as a network to go on from: scripts/brochidodromous.lua fills it by venule.venation.
---@param options venule.brochidodromous.Options
---@return {network: venule.Network, arches: integer}
function venule.brochidodromous(options) end

---@class (exact) venule.cco.Options
---@field domain? any # where everything is to lie; left out: by perfusion, square and dim
---@field terminals? any # how many each tree is to have in the end; or a list {{x, y}, …} of where they are, in their order
---@field seed? integer # of the random terminals
---@field placement? "segments"|"terminals" # what a new terminal keeps away from: vessels (section 3.3.2), or terminals and the insides of vessels (Algorithms 2 and 3)
---@field tries? integer # before the threshold of Equation 15 is lowered; left out: 100, or 1000 with "terminals"
---@field threshold? number # what the threshold is multiplied by then
---@field spacing? number # the threshold at first, in units of Equation 15
---@field candidates? integer # nearest segments that are tried; twice as many while none will do
---@field most_candidates? integer # but no more than these for one terminal, which is then drawn anew
---@field redraws? integer # terminals drawn anew before the domain counts as full
---@field foresight? number # room that new vessels need to thicken later: so that a subtree of m terminals may come to 1 + foresight / √m times its share of the flow; left out: 4 in space, 1 in the plane, and 0 for a list of terminals
---@field bifurcation? "least"|"kamiya"|"ceres" # the bifurcation point: of least volume; by Equations 8 to 13 alone; or these with the system (12) solved by Ceres
---@field border_distance? number # that vessels keep from the border
---@field growing_domain? boolean # sizes hold as if the domain grew with the tree (Equation 14)
---@field density? any # how dense terminals are at a point, 0 to 1: a function (x, y[, z]), or a domain whose values count
---@field root? table # where the tree begins, in the domain or on its border; left out: the point of the border nearest to the top of the domain's bounds
---@field from? any # a tree to grow on from instead: its nodes, not its radii
---@field inflow? number # of the whole tree at the end, shared by its terminals; 500 mL/min
---@field terminal_flow? any # of each terminal, in place of inflow; or what a terminal's share of the inflow is multiplied by: a function (x, y[, z]), or a domain whose values count
---@field viscosity? number # of the blood
---@field pressure_in? number # where blood enters; 100 mmHg
---@field pressure_out? number # where it leaves; 60 mmHg
---@field exponent? any # γ of Equation 4, 1 to 100; left out: 3. Or {{flow, exponent}, …} or function(flow): by the flow that comes to a bifurcation
---@field symmetry? number # bifurcations whose thinner vessel is below this part of the thicker are refused
---@field venous? boolean # blood enters at the terminals and leaves at the root
---@field perfusion? number # area or volume of the domain where none is given: a disk or ball around the origin; left out: 20000
---@field square? boolean # a square or cube in its place
---@field dim? integer # its dimensions; left out: 2
---@field trees? table # several trees that keep clear of each other: a list of {name=, root=, …}; options of a tree that stand outside are for all of them
---@field avoid? any # a network to keep clear of, as tubes of its radii, or a list of them
---@field stages? table # growth in parts of the domain, one after the other: a list of {domain=, terminals=}; terminals that are left then fall anywhere

---Arterial trees by constrained constructive optimisation (Kerautret et al. 2023), ready to grow. `s:run{progress=}` grows to the end: s, or where the domain is full before, false and why; `s:step()` adds a terminal to each tree, false when done; `s:grow(n)` adds up to n, and gives how many came in all. `s.network` is the tree as it is now, with radius, flow and pressure; of several trees, `s.networks` has all by name, and so has `s.arteries`; `s.report`, `s.volume`, `s.fraction`, `s.done`, `s.domain`. Units are mm, Pa, mm³/s and Pa·s; 1 mmHg is 133.322 Pa, 1 mL/min is 1000 / 60 mm³/s. What a tree of `trees` and a stage may say is below.
---@param options venule.cco.Options
---@return venule.CcoSystem
function venule.cco(options) end

---@class (exact) venule.vessels.Options
---@field domain any # the tissue: a domain, or a growth
---@field rng any # the random numbers: venule.rng(seed)
---@field arteries table # {roots = {…}}, or guides =, or network =, with options that are to hold for arteries alone
---@field veins? table # likewise; left out: none grow
---@field steps? integer # how many; left out where there are stages or the domain grows by itself: theirs
---@field growth? number # Δσ: what a step adds to the size of the tissue, by its size at first; 0: it stays
---@field stages? table # {{steps = 100, …}, …}: one after the other, each with options of its own
---@field avoid? boolean # arteries and veins keep clear of one another, as tubes of their radii
---@field unit? string # length unit that files carry
---@field perception_distance? number # δ: drains farther than this draw no vessel
---@field satisfaction? number # ε_k: a vessel this close satisfies a drain
---@field segment_length? number # d: the length a vessel gains in a step
---@field tip_radius? number # r: radius of the last segments
---@field perception_angle? number # γ: a leaf perceives what lies within half of it on either side of its direction, an inter-node around the optimal branch
---@field bias? number # ω: how much of its own direction a vessel keeps, or of the optimal branch: 1 grows straight on
---@field bias_mean? boolean # weigh ω against the mean of the directions to drains, as the authors' program does; false: against their sum, as printed
---@field bifurcation_threshold? number # φ: a leaf whose drains lie farther apart forks symmetrically
---@field bifurcate? boolean # whether leaves fork at all
---@field lateral? boolean # whether inter-nodes grow laterals
---@field murray_exponent? number # κ: r^κ adds up where vessels part, and branching angles follow from it
---@field darts? integer # thrown in each step (into a blade whose margin grows: in all); left out, with density: 1000
---@field density? number # ρ: or darts per area (volume) of the grown tissue and step
---@field weight? any # a map (a domain with values) or function(x, y[, z]), 0 to 1: which part of the darts stays where they fall; regions that lack oxygen
---@field drain_spacing? number # ε_s: a new drain keeps this far from other drains
---@field drain_clearance? number # ε_n: and this far from arteries

---Arteries and veins that grow together (Rauch & Harders 2021), ready to grow: `s:run{progress=}`, `s:step()` (false when done), `s.arteries`, `s.veins`, both by name in `s.networks`, `s.drains`, `s.sources`, `s.tissue`, `s.unit`. Lengths are those at the size that the tissue has at first; left out, they are parts of the domain's longest side. What `arteries`, `veins` and a stage may say is below. The loop is plain Lua in lua/venule/vessels.lua; copy it when an option is not enough.
---@param options venule.vessels.Options
---@return venule.VesselsSystem
function venule.vessels(options) end

---@class (exact) venule.plot.Options
---@field width? number # of the whole picture; 96 pixels are an inch on paper
---@field height? number # of the whole picture
---@field title? string # above the plot
---@field x? table # the axis to the right: {label=, log=, min=, max=}
---@field y? table # the axis upwards: {label=, log=, min=, max=}
---@field series table # a list of what is drawn: {x=, y=, deviation=, below=, band=, label=, color=, marks=, line=}
---@field background? string # a colour, or "none"
---@field text_size? number # of the numbers at the axes; labels are as large

---Numbers as a figure, on a canvas to save or draw on: lines and dots, deviations as bars or bands, plain or logarithmic axes. A legend stands where it covers nothing. What an axis and a series may say is below.
---@param options venule.plot.Options
---@return venule.Canvas
function venule.plot(options) end

---@class (exact) venule.cco.tree.Options
---@field name string # what it is called: s.name is its network
---@field root? table # where the tree begins, in the domain or on its border; left out: the point of the border nearest to the top of the domain's bounds
---@field from? any # a tree to grow on from instead: its nodes, not its radii
---@field inflow? number # of the whole tree at the end, shared by its terminals; 500 mL/min
---@field terminal_flow? any # of each terminal, in place of inflow; or what a terminal's share of the inflow is multiplied by: a function (x, y[, z]), or a domain whose values count
---@field viscosity? number # of the blood
---@field pressure_in? number # where blood enters; 100 mmHg
---@field pressure_out? number # where it leaves; 60 mmHg
---@field exponent? any # γ of Equation 4, 1 to 100; left out: 3. Or {{flow, exponent}, …} or function(flow): by the flow that comes to a bifurcation
---@field symmetry? number # bifurcations whose thinner vessel is below this part of the thicker are refused
---@field venous? boolean # blood enters at the terminals and leaves at the root

---@class (exact) venule.cco.stage.Options
---@field domain? any # the part that terminals fall into; left out: the whole domain
---@field terminals integer # how many more each tree is to have then

---@class (exact) venule.vessels.tree.Options
---@field roots? table # where trees begin: {{x, y}, …} or {{x, y, z}, …}, each with heading = {x, y} where its first segment has a direction
---@field network? any # a network to go on from, besides roots
---@field guides? any # paths that vessels follow first: {{{x, y}, …}, …}, or a network, or a file that has lines (venule.paths)
---@field perception_distance? number # δ: drains farther than this draw no vessel
---@field satisfaction? number # ε_k: a vessel this close satisfies a drain
---@field segment_length? number # d: the length a vessel gains in a step
---@field tip_radius? number # r: radius of the last segments
---@field perception_angle? number # γ: a leaf perceives what lies within half of it on either side of its direction, an inter-node around the optimal branch
---@field bias? number # ω: how much of its own direction a vessel keeps, or of the optimal branch: 1 grows straight on
---@field bias_mean? boolean # weigh ω against the mean of the directions to drains, as the authors' program does; false: against their sum, as printed
---@field bifurcation_threshold? number # φ: a leaf whose drains lie farther apart forks symmetrically
---@field bifurcate? boolean # whether leaves fork at all
---@field lateral? boolean # whether inter-nodes grow laterals
---@field murray_exponent? number # κ: r^κ adds up where vessels part, and branching angles follow from it

---@class (exact) venule.vessels.stage.Options
---@field steps integer # how many
---@field domain? any # where its drains fall and vessels grow, in the tissue's coordinates: a surface first, say, and then the inside; left out: the tissue
---@field arteries? table # options that are to hold for arteries alone
---@field veins? table # options that are to hold for veins alone
---@field perception_distance? number # δ: drains farther than this draw no vessel
---@field satisfaction? number # ε_k: a vessel this close satisfies a drain
---@field segment_length? number # d: the length a vessel gains in a step
---@field tip_radius? number # r: radius of the last segments
---@field perception_angle? number # γ: a leaf perceives what lies within half of it on either side of its direction, an inter-node around the optimal branch
---@field bias? number # ω: how much of its own direction a vessel keeps, or of the optimal branch: 1 grows straight on
---@field bias_mean? boolean # weigh ω against the mean of the directions to drains, as the authors' program does; false: against their sum, as printed
---@field bifurcation_threshold? number # φ: a leaf whose drains lie farther apart forks symmetrically
---@field bifurcate? boolean # whether leaves fork at all
---@field lateral? boolean # whether inter-nodes grow laterals
---@field murray_exponent? number # κ: r^κ adds up where vessels part, and branching angles follow from it
---@field darts? integer # thrown in each step (into a blade whose margin grows: in all); left out, with density: 1000
---@field density? number # ρ: or darts per area (volume) of the grown tissue and step
---@field weight? any # a map (a domain with values) or function(x, y[, z]), 0 to 1: which part of the darts stays where they fall; regions that lack oxygen
---@field drain_spacing? number # ε_s: a new drain keeps this far from other drains
---@field drain_clearance? number # ε_n: and this far from arteries

---@class (exact) venule.plot.axis.Options
---@field label? string # what it measures, and the unit
---@field log? boolean # logarithmic: for values above 0
---@field min? number # where it begins; left out: so that all is seen
---@field max? number # where it ends; left out: so that all is seen

---@class (exact) venule.plot.series.Options
---@field x any # a list of numbers; a point that has one that is not finite is left out, and breaks the line
---@field y any # a list of as many numbers
---@field deviation? any # a list of as many, or one number: y is drawn with so much above and below it
---@field below? any # the deviations below, where these are not those above
---@field band? boolean # deviations as a band instead of bars
---@field label? string # what it is, in the legend
---@field color? string # left out: one that the others have not
---@field marks? boolean # a dot at each point; left out: where there are 60 or fewer
---@field line? boolean # a line from point to point

---@class (exact) venule.leaf.entire.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.5 of the length
---@field widest? number # where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "cuneate"|"rounded"|"truncate" # wedge-shaped, round, or cut off
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A blade with a smooth margin, from linear to round, ovate to obovate.
---@param options? venule.leaf.entire.Options
---@return venule.Domain
function venule.leaf.entire(options) end

---@class (exact) venule.leaf.toothed.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.6 of the length
---@field widest? number # where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "cuneate"|"rounded"|"truncate" # wedge-shaped, round, or cut off
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---The same with a toothed margin: small teeth upon large ones.
---@param options? venule.leaf.toothed.Options
---@return venule.Domain
function venule.leaf.toothed(options) end

---@class (exact) venule.leaf.poplar.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.85 of the length
---@field widest? number # where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "cuneate"|"rounded"|"truncate" # wedge-shaped, round, or cut off
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A blade broad at its foot with a drawn-out tip and small blunt teeth.
---@param options? venule.leaf.poplar.Options
---@return venule.Domain
function venule.leaf.poplar(options) end

---@class (exact) venule.leaf.orchid.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.26 of the length
---@field widest? number # where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "cuneate"|"rounded"|"truncate" # wedge-shaped, round, or cut off
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A lance-shaped blade of parallel veins.
---@param options? venule.leaf.orchid.Options
---@return venule.Domain
function venule.leaf.orchid(options) end

---@class (exact) venule.leaf.petal.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.55 of the length
---@field widest? number # where it is widest: 0 is the base, 1 the tip (ovate below 0.5, obovate above)
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "cuneate"|"rounded"|"truncate" # wedge-shaped, round, or cut off
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A petal of trillium: broadest above its middle, pointed, narrow at its foot.
---@param options? venule.leaf.petal.Options
---@return venule.Domain
function venule.leaf.petal(options) end

---@class (exact) venule.leaf.linear.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.06 of the length
---@field taper? number # the share of the length in which it narrows to its tip
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A grass blade; its base is as wide as the blade, for a row of seed nodes (venule.leaf.base).
---@param options? venule.leaf.linear.Options
---@return venule.Domain
function venule.leaf.linear(options) end

---@class (exact) venule.leaf.cordate.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.85 of the length
---@field widest? number # where it is widest, before the base is hung
---@field lobe? number # how far the base hangs below the petiole, of the length
---@field tip? "rounded"|"acute"|"acuminate"|"caudate" # caudate: drawn out into a tail
---@field base? "rounded"|"truncate" # of the blade before it is hung
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---Heart-shaped: the base hangs below the petiole, at both sides of a notch.
---@param options? venule.leaf.cordate.Options
---@return venule.Domain
function venule.leaf.cordate(options) end

---@class (exact) venule.leaf.digitate.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: as the lobes make it
---@field count? integer # lobes; odd
---@field sinus? number # how near the petiole the bays between lobes come, of a lobe's length
---@field spread? number # between the outermost lobes
---@field outer? number # the length of the outermost lobes, of that in the middle
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---Lobes like fingers: maple, sweetgum. Each is a ray from the petiole.
---@param options? venule.leaf.digitate.Options
---@return venule.Domain
function venule.leaf.digitate(options) end

---@class (exact) venule.leaf.reniform.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: as the lobes make it
---@field count? integer # lobes; odd
---@field depth? number # of the bays between lobes, of the radius there
---@field sinus? number # how wide the notch at the petiole opens
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---Kidney-shaped to round, with shallow round lobes: lady's mantle.
---@param options? venule.leaf.reniform.Options
---@return venule.Domain
function venule.leaf.reniform(options) end

---@class (exact) venule.leaf.fan.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: as the fan opens
---@field spread? number # between the two sides
---@field notch? number # depth of the notch, of the length
---@field wave? number # height of the waves of the margin, of the length
---@field teeth? table # waves of teeth along the margin, as venule.leaf.teeth has them

---A fan with straight sides and a notch at its top: ginkgo. Its length is that of the halves.
---@param options? venule.leaf.fan.Options
---@return venule.Domain
function venule.leaf.fan(options) end

---@class (exact) venule.leaf.lobed.Options
---@field length? number # from the petiole to the tip
---@field width? number # where it is widest; left out: 0.6 of the length
---@field count? integer # lobes at each side
---@field depth? number # of the bays, of the half width there

---Lobes off a midrib: oak. Not star-shaped, so not a shape for growth.marginal.
---@param options? venule.leaf.lobed.Options
---@return venule.Domain
function venule.leaf.lobed(options) end

---The points {{x, y}, …} of a shape's outline, counterclockwise from the petiole: `venule.leaf.outline("fan", {notch = 0})`.
---@param shape string
---@param options? table
---@return number[][]
function venule.leaf.outline(shape, options) end

---Teeth upon an outline whose first point is the petiole and whose highest is the tip: sums of triangular waves {{count, depth, skew}, …} (Runions §3.2). `count` teeth at each side, `depth` of the outline's length, `skew` (0.5) where a tooth is highest. Where the petiole saw the whole margin it still does: what a tooth would hide is cut off. Another outline may come to cross itself.
---@param points number[][]
---@param waves number[][]
---@return number[][]
function venule.leaf.teeth(points, waves) end

---n seed points {{x, y}, …} just inside the blade: evenly along its base, for parallel veins; where the blade hangs below its petiole, on a small arc about that.
---@param blade venule.Domain|venule.Growth
---@param n integer
---@return number[][]
function venule.leaf.base(blade, n) end

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

---@class (exact) venule.disk.Options
---@field center? number[] # its middle, length
---@field radius? number # from the middle to the border, length (default 1)

---A disk.
---@param options venule.disk.Options
---@return venule.Domain
function venule.domain.disk(options) end

---@class (exact) venule.disk.Options
---@field center? number[] # its middle, length
---@field radius? number # from the middle to the border, length (default 1)

---A ball in 3D.
---@param options venule.disk.Options
---@return venule.Domain
function venule.domain.sphere(options) end

---@class (exact) venule.box.Options
---@field min number[] # its corner of least coordinates, length
---@field max number[] # the opposite corner; two coordinates make a flat box, three a solid one, length

---An upright rectangle, or in 3D a box.
---@param options venule.box.Options
---@return venule.Domain
function venule.domain.box(options) end

---A polygon with holes: `polygon{outer, hole, …}`, each ring a list of points {x, y}; a single ring may stand without the outer braces. Orientation is free; a ring inside another is a hole.
---@param rings number[][][]
---@return venule.Domain
function venule.domain.polygon(rings) end

---@class (exact) venule.profile.Options
---@field length? number # from the base at (0, 0) to the tip at (0, length), length (default 1)
---@field samples? integer # how many points of a half_width function are taken (a table is taken as it is), points (default 200)
---@field half_width any # half the blade's width along its midrib; 0 or more, length

---A leaf blade by its half width along the midrib, the y axis.
---@param options venule.profile.Options
---@return venule.Domain
function venule.domain.profile(options) end

---@class (exact) venule.svg.Options
---@field id? string # id of the shape, or of a group of shapes, that is the outline; otherwise pick decides
---@field pick? "largest"|"all" # without an id: the filled shape of the largest area, or everything filled, united (default "largest")
---@field tolerance? number # curves become polylines that are within this of them; 0 for 1e-4 of the shape's size, length (default 0)
---@field repair? boolean # accept outlines that cross themselves, and fill them as a painter would (default false)

---The outline of a shape in an SVG file, y up: in the user units of its viewBox, whose lower left corner becomes (0, 0), or in mm when the file gives its width in mm, cm, in or pt.
---@param path string
---@param options? venule.svg.Options
---@return venule.Domain
function venule.domain.svg(path, options) end

---@class (exact) venule.image.Options
---@field threshold? number # inside are pixels of this brightness or more: black is 0, white is 1 (default 0.5)
---@field invert? boolean # inside are darker pixels instead, and values are those of the negative (default false)
---@field pixel? number # the side of a pixel, length (default 1)
---@field component? "one"|"largest"|"all" # what of a mask whose parts do not hang together by sides of pixels: nothing, unless the others are specks of a thousandth in all; the largest part; all (default "one")

---What is bright in a picture (.png, .pgm), y up, with its lower left corner at (0, 0): the squares of its pixels, whose values `d:value` gives. With `threshold = 0` the whole picture is a map of density.
---@param path string
---@param options? venule.image.Options
---@return venule.Domain
function venule.domain.image(path, options) end

---@class (exact) venule.volume.Options
---@field threshold? number # inside are voxels of this value or more; left out: 0.5, and 128 in a .vol
---@field invert? boolean # inside are voxels below it instead (default false)
---@field component? "one"|"largest"|"all" # what of a mask whose parts do not hang together by faces of voxels: nothing, unless the others are specks of a thousandth in all; the largest part; all (default "one")

---What is inside in a volume of voxels, in 3D: NIfTI (.nii, .nii.gz), NRRD (.nrrd) or DGtal's .vol, in the file's own coordinates and unit (NRRD's turned to right, anterior, superior as NIfTI has them). `d:value` is a voxel's value over the greatest inside.
---@param path string
---@param options? venule.volume.Options
---@return venule.Domain
function venule.domain.volume(path, options) end

---@class (exact) venule.mesh.Options
---@field on? "surface"|"inside" # what of the mesh is the domain: its surface, or what it encloses (default "surface")
---@field check? boolean # of an inside: refuse a mesh that crosses itself; without, what is in two of its parts is outside (default true)
---@field repair? boolean # mend vertices that nearly coincide, faces that are there twice, have no area or are turned, open seams and, for an inside, holes; otherwise such a mesh is refused (default false)

---The surface of a mesh in 3D, or with `on = "inside"` what it encloses: of an .obj, .off, .ply, .glb, .gltf or .stl file, or of a table of vertices {x, y, z} and of faces {a, b, c, …}, which count the vertices from 1. Veins grow along a surface: new nodes are brought onto it, no edge crosses its border or jumps from one sheet of a fold to another. Distances are straight ones in space: `within` should be below the distance of folds. For an inside the mesh has to be closed; a shell in a shell bounds a cavity, whichever way their faces turn. With `repair = true` broken meshes are mended as far as that can be, and a second result says how much: {merged = vertices that nearly coincided, removed = faces that were there twice or had no area, turned = faces, sewn = pairs of edges, holes =, largest_hole = edges}.
---@param mesh string|{vertices: number[][], faces: integer[][]}
---@param options? venule.mesh.Options
---@return venule.Domain, table?
function venule.domain.mesh(mesh, options) end

---@class (exact) venule.shell.Options
---@field domain venule.Domain|venule.Growth # what it is the shell of
---@field thickness number # how far it reaches inwards from the border, length

---What of a domain is near its border: everything but a core that is `thickness` inside. Of a growing domain, always of today's shape.
---@param options venule.shell.Options
---@return venule.Domain
function venule.domain.shell(options) end

---@class (exact) venule.none.Options
---@field domain venule.Domain|venule.Growth # the shape, which stays as it is

---A domain that stays as it is.
---@param options venule.none.Options
---@return venule.Growth
function venule.growth.none(options) end

---@class (exact) venule.marginal.Options
---@field domain venule.Domain|venule.Growth # the shape of the blade
---@field origin? number[] # the petiole, about which the margin is scaled; left out: the lowest point of the outline, length
---@field from? number # the blade's length at first; left out: a twentieth of `to`, length
---@field to? number # its length when grown; left out: the domain's own length, its extent along y, length
---@field step? number # the length that each step adds; left out: a hundredth of to - from, length

---A blade of which only the margin moves, scaled about the petiole (Runions §3.3). Attractors thrown into it are thrown over the largest shape at once, and released as the margin passes them.
---@param options venule.marginal.Options
---@return venule.Growth
function venule.growth.marginal(options) end

---@class (exact) venule.isogonic.Options
---@field domain venule.Domain|venule.Growth # the shape of the blade, at any size
---@field origin? number[] # the petiole, about which the shape is scaled to `from`; left out: the lowest point of the outline, or in 3D the middle of the bottom (least y) of its bounds, length
---@field from? number # the blade's length at first, and that of its shape in the simulation; left out: a twentieth of `to`, length
---@field to? number # its length when grown; left out: the domain's own length, its extent along y, length
---@field step? number # the length that each step adds; left out: a hundredth of to - from, length
---@field split? number # edges longer than this times the unit are split; 0: none, older edges stretch, length (default 0)

---A blade that grows alike everywhere, computed by shrinking the unit (READINGS R7): its shape has the length `from` and stays, `length` runs from `from` to `to`, and `unit` is from / length. Multiply lengths by `unit` and divide densities by its square.
---@param options venule.isogonic.Options
---@return venule.Growth
function venule.growth.isogonic(options) end

---@class (exact) venule.uniform.Options
---@field domain venule.Domain|venule.Growth # the shape of the blade at first
---@field origin? number[] # the petiole, which stays; left out: the lowest point of the outline, or in 3D the middle of the bottom (least y) of its bounds, length
---@field x? number # growth factor a step across; 1: none (default 1)
---@field y? number # growth factor a step along; 1: none (default 1)
---@field z? number # growth factor a step in depth, in 3D; 1: none (default 1)
---@field steps? integer # how many steps it grows, steps (default 100)
---@field split? number # edges that growth makes longer than this are split; about two vein segments; 0: none, length (default 2)

---A blade that grows by one factor a step across, one along and, in 3D, one in depth; its tissue moves. In 3D boxes and meshes are exact in all they answer; the distance to the border of others is never more than the true one.
---@param options venule.uniform.Options
---@return venule.Growth
function venule.growth.uniform(options) end

---@class (exact) venule.rerg.Options
---@field domain venule.Domain|venule.Growth # the shape of the blade at first
---@field origin? number[] # the petiole, which stays and from which heights count; left out: the lowest point of the outline, length
---@field x? any # growth factor a step across, by the height y0 at first; through points {y0, f} runs a monotone spline; 1: none
---@field y? any # growth factor a step along, likewise
---@field steps? integer # how many steps it grows, steps (default 100)
---@field samples? integer # how many samples of a function or spline are taken, evenly spaced; f is linear in between, samples (default 16384)
---@field split? number # edges that growth makes longer than this are split; about two vein segments; 0: none, length (default 2)

---A blade that grows by factors that vary along it (Runions, appendix): x(t) = x0 f_x(y0)^t and y(t) = ∫ f_y^t dy from 0 to y0, where y0 is the height above the origin at first. Its tissue moves.
---@param options venule.rerg.Options
---@return venule.Growth
function venule.growth.rerg(options) end

---@class (exact) venule.morph.Options
---@field domains any # the outlines from first to last, each of one ring
---@field origin? number[] # outlines are matched from their points nearest to it; left out: from their lowest points, length
---@field steps? integer # how many steps there are from the first outline to the last, steps (default 100)
---@field samples? integer # evenly spaced points that an outline is made of, besides its corners, points (default 512)
---@field split? number # edges that growth makes longer than this are split; about two vein segments; 0: none, length (default 2)

---A blade that grows from outline to outline (Webb 2020); its tissue moves, by mean value coordinates.
---@param options venule.morph.Options
---@return venule.Growth
function venule.growth.morph(options) end

---Where something may grow. Domains combine: `blade - hole`, `a + b`, `a * b`.
---@class venule.Domain
---@operator sub(venule.Domain): venule.Domain
---@operator add(venule.Domain): venule.Domain
---@operator mul(venule.Domain): venule.Domain
---@field dim integer # 2 or 3
---@field measure_dim integer # 2 where its measure is an area, 3 where it is a volume
---@field unit string # the length unit of its file, or ""
local Domain = {}

---Whether a point is inside.
---@param x number
---@param y number
---@param z? number
---@return boolean
function Domain:contains(x, y, z) end

---The distance to the border: positive inside, negative outside. Beside a surface: to the surface.
---@param x number
---@param y number
---@param z? number
---@return number
function Domain:distance(x, y, z) end

---The border's nearest point. Beside a surface: the surface's.
---@param x number
---@param y number
---@param z? number
---@return number, number, number?
function Domain:closest(x, y, z) end

---Its value there, in [0, 1]: 1 inside and 0 outside where it has no values of its own.
---@param x number
---@param y number
---@param z? number
---@return number
function Domain:value(x, y, z) end

---The box around it: {min = {…}, max = {…}}.
---@return venule.Bounds
function Domain:bounds() end

---Its area, or in 3D its volume; of a surface its area.
---@return number
function Domain:measure() end

---@class (exact) venule.sample.Options
---@field spacing? number # a point this close to an earlier one is refused; left out: none is, length
---@field rng venule.Rng # the random numbers: venule.rng(seed)

---Throw n darts, uniformly distributed; the points {x, y} of those that stick. `rng` is required; with `spacing` a dart that close to an earlier one is refused.
---@param n integer
---@param options venule.sample.Options
---@return number[][]
function Domain:sample(n, options) end

---A domain that changes with time; accepted wherever a domain is.
---@class venule.Growth: venule.Domain
---@field kind string # none, marginal, isogonic, uniform, rerg or morph
---@field time integer # steps taken
---@field steps integer # steps from first to grown
---@field grown boolean # whether advance() has nothing left to do
---@field measure_dim integer # 2 where its measure is an area, 3 where it is a volume
---@field length number # today's length
---@field final_length number # the length when grown
---@field unit number # today's unit length in the simulation's coordinates: 1 at first (READINGS R7)
---@field origin number[] # the petiole {x, y}, which stays where it is; a morph's moves with its outline
---@field dim integer # 2 or 3
local Growth = {}

---Grow by one step. Networks and attractors move with the tissue, edges stretched beyond `split` are split, and the attractors that a margin has passed are released, away from the network. False when it was grown already.
---@param ... venule.Network|venule.Attractors
---@return boolean
function Growth:advance(...) end

---`g:map(x, y[, z], t1, t2)`: where the tissue that is there at time t1 is at time t2; times are steps, and may be fractions. Under none, marginal and isogonic growth it keeps its coordinates.
---@param x number
---@param y number
---@param ... number
---@return number, number, number?
function Growth:map(x, y, ...) end

---What grows: a forest of nodes, and joins that close loops. `#net` nodes, numbered from 1.
---@class venule.Network
---@field x number[] # the nodes' coordinates
---@field y number[] # the nodes' coordinates
---@field z number[] # the nodes' coordinates; 0 in 2D
---@field parent integer[] # each node's parent, 0 at a root
---@field radius number[] # of the edge to the parent; at a root, of its thickest child
---@field order integer[] # of that edge, once net:orders(…) was called
---@field flow number[] # through that edge (length³/s), what enters at a root; once net:flow{…} was called
---@field pressure number[] # at the nodes (Pa), likewise
---@field tree integer[] # which root each node hangs from, counted from 1
---@field birth integer[] # the step each node was born in
---@field dim integer # 2 or 3
---@field unit string # the length unit that files carry
local Network = {}

---Add a root; its index.
---@param x number
---@param y number
---@param z? number
---@return integer
function Network:root(x, y, z) end

---Add a child of a node; its index.
---@param parent integer
---@param x number
---@param y number
---@param z? number
---@return integer
function Network:add(parent, x, y, z) end

---Put a new node into the edge between a node and its parent; its index.
---@param node integer
---@param x number
---@param y number
---@param z? number
---@return integer
function Network:split(node, x, y, z) end

---Close a loop by an edge from a to b, whose parent a becomes too. `radius` holds while no law does.
---@param a integer
---@param b integer
---@param radius? number
function Network:join(a, b, radius) end

---@class (exact) venule.murray.Options
---@field exponent? number # n in r_parent^n = Σ r_child^n: 3 by Murray, 2 in most of Runions' leaves (default 3)
---@field tip_radius? number # radius of the edges that end in a tip, length (default 1)
---@field veinlets? number # what each node of a primary or secondary vein takes up besides its children, for veinlets that are not modeled, tips (default 0)

---Give the edges radii by Murray's law; from now on they follow it, however the network grows.
---@param options venule.murray.Options
function Network:murray(options) end

---The direction that the first segment from a root is to take, for what the root perceives.
---@param root integer
---@param x number
---@param y number
---@param z? number
function Network:heading(root, x, y, z) end

---@class (exact) venule.perception.Options
---@field angle number # γ: a leaf perceives what lies within half of it on either side of its direction, degrees
---@field lateral? boolean # whether inter-nodes perceive too, around Murray's optimal branch, and grow laterals (default true)

---What a vessel's node perceives (Rauch & Harders, Equations 2 and 3): a "cone" around `direction`, a "belt" at `angle` degrees from it, the whole "ball", or "none" when it cannot grow any more.
---@param node integer
---@param options venule.perception.Options
---@return {kind: string, angle: number, direction: number[]}
function Network:zone(node, options) end

---@class (exact) venule.extend.Options
---@field length number # D, the length of a new vein segment, length
---@field domain? venule.Domain|venule.Growth # an edge that would leave it is not made; its attractor turns to the nearest node that sees it
---@field meet? "cross"|"join"|"stop" # what a vein does that would cross another one: go on across it, as in the papers, end there, joined to it, or not grow (both in 2D); what drew that vein alone is then given up (default "cross")
---@field bias? number # ω, with perception: how much of a vessel's own direction is in that of its next segment (default 0)
---@field bias_mean? boolean # weigh the mean of the directions to attractors against that, rather than their sum (default false)
---@field bifurcate? number # φ, with perception: a leaf whose attractors lie farther apart forks symmetrically; left out: none does, degrees
---@field avoid? any # networks whose edges this one's keep clear of, as round tubes, now and as they grow thicker; those that grow by turns must each avoid the other
---@field gap? number # what a new edge leaves free beside those to be avoided, for both to grow thicker; left out: a quarter of `length`, length

---Grow each influenced node by one segment in the mean direction of its attractors (Runions, Equation 1). How many nodes were added, and the first of them; when it adds none and nothing else changes, no later call will. `avoid = other` keeps this network clear of others for good; those that grow by turns must each avoid the other.
---@param influence venule.Influence
---@param options venule.extend.Options
---@return integer, integer
function Network:extend(influence, options) end

---@class (exact) venule.follow.Options
---@field length number # d, of the new edges: each path is cut into equal parts of about that length, length
---@field within? number # how far from the network a path may begin, and how far off a surface it may be; 0: length, length (default 0)
---@field domain? venule.Domain|venule.Growth # what paths have to stay in, or what surface they are brought onto; left out: anywhere
---@field name? string # what errors call the paths (default "paths")

---Lay vessels along paths (Rauch & Harders, Figure 4): each is a list of points {x, y} or {x, y, z}, and begins at the node nearest to its first point, which an earlier path may have made; in an empty network that point is the root. How many nodes were added, and the first of them.
---@param paths number[][][]
---@param options venule.follow.Options
---@return integer, integer
function Network:follow(paths, options) end

---The children of a node, in the order of birth.
---@param node integer
---@return integer[]
function Network:children(node) end

---The extra edges that close loops, with their radii; by Murray's law a is the parent. `flow`, from a to b, once net:flow{…} was called.
---@return {a: integer, b: integer, radius: number, flow?: number}[]
function Network:joins() end

---@class (exact) venule.orders.Options
---@field ratio? number # hickey: a lateral this many times as thick as the thickest child has its order too; left out: none has

---Compute the vein order of every edge, read as `net.order`. Pictures then have a layer an order. Joins are nobody's children; a join has the higher order of its ends.
---@param kind "strahler"|"horton"|"hickey"
---@param options? venule.orders.Options
function Network:orders(kind, options) end

---@class (exact) venule.measure.Options
---@field leaf? any # measure it as botanists measure leaves too (2D): the field `leaf` of what comes back
---@field domain? venule.Domain|venule.Growth # the blade, whose area counts; left out: the convex hull of the nodes
---@field resolution? number # spacing of the points of the map of distances to veins; left out: 40,000 in the area, length

---Counts, length and extent: nodes, roots, tips, bifurcations, joins, depth, length, min_radius, max_radius, extent. With `leaf = true` also what botanists measure in leaves, as `leaf`: vein density, areoles, free ends, junctions, the hierarchy of loops, angles, distances to veins.
---@param options? venule.measure.Options
---@return venule.Measures
function Network:measure(options) end

---@class (exact) venule.measure_vessels.Options
---@field exponent? number # κ in r_parent^κ = Σ r_child^κ, as murray's; left out: that of the law in force, or 3
---@field orders? "strahler"|"diameter" # by Strahler: tips 1, one more where two of the highest meet; by diameter: one more where a vessel is too thick for the order of its daughters (after Jiang, Kassab & Fung 1994) (default "strahler")
---@field bins? integer # of the daughters' ratio r2/r1 from 0 to 1, for angles, bins (default 10)

---What anatomists measure in vessels. By how much Murray's law is missed where three edges or more meet (`murray`), and the exponents that would keep it (`fitted`). At bifurcations, nodes with a parent and two children: the daughters' `ratio` r2/r1, their area by the parent's (`expansion`), `angles` in degrees between the daughters and of the thick and the thin one to the parent's direction, by bins of the ratio with Murray's optimal angles (`theory`). Diameter, length and count by order, of segments (from fork to fork) and of elements (segments of one order in series), and the ratios from order to order, by regression. `tortuosity` is arc by chord, `curvature` the mean squared curvature along (radians²/length²). Lengths are the network's. Joins are nobody's children: they count for Murray's law alone.
---@param options? venule.measure_vessels.Options
---@return venule.VesselMeasures
function Network:measure_vessels(options) end

---@class (exact) venule.measure_boxes.Options
---@field coarsest? integer # the largest boxes have the longest side of the nodes' bounds by 2 to this power (default 2)
---@field finest? integer # the smallest boxes likewise; above coarsest, and in 3D at most 10 (default 8)
---@field offsets? integer # each shifted by a part of the largest box; the least count holds, grids (default 16)

---The box-counting dimension, always by one protocol: boxes of the extent / 2^k, where the extent is the longest side of the nodes' bounds; a box counts when an edge passes it, exactly; of several grids, each shifted by a part of the largest box (Halton's points, bases 3, 5, 7), the least count of each size; the slope of the least-squares line of ln count over ln 1/side. By the default range, in whatever direction they lie, straight lines have 1 to 1.05, filled squares 1.85 to 2.03, Koch's curve (1.262) 1.27 to 1.33 and Sierpinski's triangle (1.585) 1.58 to 1.64: dimensions compare with others by this protocol. Boxes smaller than the mesh of a network see lines only: let `finest` suit it, and look at `boxes`.
---@param options? venule.measure_boxes.Options
---@return venule.Boxes
function Network:measure_boxes(options) end

---@class (exact) venule.measure_tissue.Options
---@field domain venule.Domain|venule.Growth # the tissue: flat, solid or a surface
---@field from? "surface"|"centerline" # of vessels; where no radii are known it is the center line (default "surface")
---@field reach? number # tissue at most this far from a vessel is perfused; left out: not asked, length
---@field resolution? number # spacing of the points; left out: 40,000 in an area or on a surface, 262,144 in a volume, length
---@field bins? integer # of the histogram, from 0 to the largest distance, bins (default 20)

---How far the points of a domain are from the nearest vessel: statistics, the `furthest` point, the most frequent distance (`mode`), a `histogram`, the share of points in vessels (`lumen`, 0 away) and within `reach` (`perfused`). Points are on a square or cubic grid; on surfaces at random, evenly by area, with distances straight through space. No point is much farther than `furthest`: from one point to another distances differ by no more than these are apart.
---@param options venule.measure_tissue.Options
---@return venule.Tissue
function Network:measure_tissue(options) end

---@class (exact) venule.flow.Options
---@field solve? any # false: leave flows and pressures as they are, and check them; left out: find them first
---@field viscosity? number # of what flows: 3.6 cP is blood's, Pa s (default 0.0036)
---@field pressure_in? number # at every root: 13332.2 Pa is 100 mmHg, Pa (default 13332.2)
---@field pressure_out? number # at every terminal, a node other than a root with a single edge: 7999.32 Pa is 60 mmHg, Pa (default 7999.32)
---@field inflow? number # what enters in all, in place of the pressure where `share` says; left out: pressures hold, length³/s
---@field share? "roots"|"terminals" # who lets `inflow` through in equal shares; pressures hold at the others (default "roots")
---@field terminal_flow? number # what each terminal takes, in place of pressure_out; left out: pressures hold, length³/s
---@field exponent? number # of Murray's law, for its residual (default 3)

---Solve Poiseuille's law for the flow in every edge (then read as `net.flow`, joins' by net:joins()) and the pressure at every node (`net.pressure`), and say what can be said of them. Pressures are in Pa, lengths L in the network's unit, flows in L³/s (mm³/s for mm), shear stresses in Pa. Pressures hold at roots and terminals unless a flow is given. With `solve = false` the flows and pressures that the network has, from a file or from growth, are checked instead: each of `conservation`, `drop` (Poiseuille's, along edges) and `terminal` (pressures against pressure_out) is the largest relative error and the node or join where it is. print(report) is one line of it.
---@param options? venule.flow.Options
---@return venule.FlowReport
function Network:flow(options) end

---Diameter, length and flow of segments by bifurcation level, from level 0 at the root: a list; in it also statistics of the daughters' symmetry (thinnest radius by thickest), of length by diameter, and of the angle between two daughters. A segment runs from fork to fork. Joins are nobody's children.
---@return venule.Levels
function Network:levels() end

---Multiply all coordinates and radii.
---@param factor number
function Network:scale(factor) end

---The network in voxels: `net:voxels {resolution = 0.5, content = "radius"}:save "radius.nii.gz"`. See venule.voxels.
---@param options? venule.voxels.Options
---@return venule.Volume
function Network:voxels(options) end

---Write the network by the extension: .json, .xml, .gxl, .vtp, .swc, .csv, .txt (docs/formats.md).
---@param path string
function Network:save(path) end

---Points that attract: auxin sources, oxygen drains. `#a` of them, numbered from 1.
---@class venule.Attractors
---@field x number[] # the attractors' coordinates
---@field y number[] # the attractors' coordinates
---@field z number[] # the attractors' coordinates; 0 in 2D
---@field dim integer # 2 or 3
---@field dormant integer # how many wait beyond a growing margin
---@field retired {hidden: integer, circled: integer, barred: integer} # how many were given up: hidden, as no node sees them without leaving the domain; circled, as veins grew for them and came no nearer; barred, as the vein would have crossed another one, or come too near to a network to be avoided
local Attractors = {}

---Add one.
---@param x number
---@param y number
---@param z? number
function Attractors:add(x, y, z) end

---@class (exact) venule.throw.Options
---@field domain venule.Domain|venule.Growth # where the darts fall
---@field count? integer # how many darts; or give `density`, darts
---@field density? number # darts per area (volume) of the domain; a fraction of a dart is carried to the next call, darts/length²
---@field spacing? number # birth distance b_s: a dart this close to an attractor is refused; left out: none is, length
---@field clearance? number # birth distance b_v: a dart this close to a node of `network` is refused; left out: none is, length
---@field network? venule.Network # what `clearance` keeps clear of
---@field weight? any # what part of the darts is kept at a place, 0 to 1: a map's values, or what the function returns; left out: all
---@field rng venule.Rng # the random numbers: venule.rng(seed)

---Throw darts at a domain; how many stuck. Each is accepted when it is farther than `spacing` from all attractors and farther than `clearance` from all nodes of `network` (Runions §3.3). With a `weight`, first each is kept with that probability: a map's values (`venule.domain.image`, `venule.domain.volume`), 1 inside any other domain and 0 outside, or what a function of the place returns, from 0 to 1. A marginal growth's darts are weighed once, all over its square.
---@param options venule.throw.Options
---@return integer
function Attractors:throw(options) end

---@class (exact) venule.influence.Options
---@field mode? "nearest"|"relative"|"urquhart" # which nodes an attractor influences: the nearest one (open venation, Runions §3), its relative neighbors (closed venation, §4), or the Urquhart approximation of these (§5.2) (default "nearest")
---@field within? number # attraction distance: nodes farther away are not influenced; left out: any distance, length
---@field perception? any # what the nodes of a vessel perceive (Rauch & Harders, Equations 2 and 3); left out: they look all around

---Which attractors influence which nodes; good until the attractors or the network change.
---@param network venule.Network
---@param options? venule.influence.Options
---@return venule.Influence
function Attractors:influence(network, options) end

---@class (exact) venule.consume.Options
---@field distance number # kill distance: an attractor that a node is closer to is consumed, length
---@field mode? "any"|"all"|"tagged" # which nodes must be that close: any one (open venation, Runions §3.3), all that it influences (Webb), or all whose veins it influenced when the first one came (closed venation, §4) (default "any")
---@field into? venule.Attractors # a set that the consumed ones are added to

---Remove the attractors that the network has reached; how many.
---@param network venule.Network
---@param options venule.consume.Options
---@return integer
function Attractors:consume(network, options) end

---Which attractors influence which nodes; `#f` pairs.
---@class venule.Influence
local Influence = {}

---Iterate: `for attractor, node in f:pairs() do … end`, by attractor, then node.
---@return fun(): integer, integer
function Influence:pairs() end

---A picture: a list of what was drawn, which becomes a file when it is saved.
---@class venule.Canvas
---@field width number # pixels
---@field height number # pixels
---@field scale number # pixels to one unit of the view's length
local Canvas = {}

---@class (exact) venule.fill.Options
---@field color? string # colour of the inside, or "none" (default "#dfe9c8")
---@field opacity? number # 0 is invisible, 1 hides what is behind (default 1)
---@field stroke? string # colour of the outline, or "none" (default "none")
---@field line_width? number # width of the outline; 0: one pixel, length (default 0)

---Fill a domain, or today's shape of a growth; through a camera also the surface of a mesh, a ball or a box.
---@param domain venule.Domain|venule.Growth
---@param options? venule.fill.Options
function Canvas:fill(domain, options) end

---@class (exact) venule.stroke.Options
---@field color? string # colour of the veins (default "#2f4f2a")
---@field color_by? any # what each edge's colour tells, instead of `color`: a column of the network (radius and flow by their logarithm), or one number or colour a node; numbers have their colour in `ramp`
---@field ramp? string # colours between spaces, from that of the least number to that of the greatest (default "#3b5ba5 #5fa8a0 #e3c565 #d9733c #a4262c")
---@field opacity? number # 0 is invisible, 1 hides what is behind; veins that cross do not darken each other (default 1)
---@field width? any # width of the edges; "radius", the default, is twice each edge's radius, length
---@field min_width? number # no edge is drawn thinner than this, so that the finest veins do not vanish, pixels (default 0.3)
---@field hide_below? number # edges thinner than this are left out, so that a large network makes a small file; 0: none is, pixels (default 0)

---Draw a network with round ends, tapered where radii differ. `width` is "radius" (the default), a number, or a function of the node. Through a camera veins are tubes, painted from far to near together with the networks and dots that are drawn right before and after.
---@param network venule.Network
---@param options? venule.stroke.Options
function Canvas:stroke(network, options) end

---@class (exact) venule.dots.Options
---@field color? string # colour of the dots (default "#c0392b")
---@field opacity? number # 0 is invisible, 1 hides what is behind; dots that overlap do not darken each other (default 1)
---@field radius? number # of each dot; 0: two pixels, length (default 0)

---A dot at each attractor, or at each point {x, y} of a list. Through a camera, dots with a radius are balls.
---@param points venule.Attractors|number[][]
---@param options? venule.dots.Options
function Canvas:dots(points, options) end

---@class (exact) venule.line.Options
---@field color? string # colour of the line, or "none" (default "#222222")
---@field opacity? number # 0 is invisible, 1 hides what is behind (default 1)
---@field width? number # of the line, pixels (default 1)
---@field fill? string # colour of the inside of a line that is then closed, or "none" (default "none")

---A line through the points {x, y} of a list. With a `fill` it is closed.
---@param points number[][]
---@param options? venule.line.Options
function Canvas:line(points, options) end

---@class (exact) venule.text.Options
---@field at? number[] # where the line of text stands, in the view's coordinates, length
---@field color? string # colour of the letters (default "#222222")
---@field size? number # height of the letters, pixels (default 14)
---@field opacity? number # 0 is invisible, 1 hides what is behind (default 1)
---@field anchor? "start"|"middle"|"end" # which part of the text is at `at` (default "start")
---@field angle? number # by which the line is turned, counterclockwise, degrees (default 0)

---Write one line of text.
---@param text string
---@param options venule.text.Options
function Canvas:text(text, options) end

---Write the picture: .png, .svg, .pdf or .eps by the path's extension.
---@param path string
function Canvas:save(path) end

---Voxels of networks: masks, labels, radii. `volume:close()` gives a large one's memory back at once.
---@class venule.Volume
---@field size integer[] # voxels in x, y and z; 1 in z when flat
---@field resolution number # side of a voxel
---@field type string # "u8", "u16", "u32" or "f32"
---@field unit string # of the resolution
local Volume = {}

---What a voxel says; they are counted from 1. A flat volume needs no `k`.
---@param i integer
---@param j integer
---@param k? integer
---@return number
function Volume:at(i, j, k) end

---Where the middle of a voxel is: x, y, z.
---@param i integer
---@param j integer
---@param k? integer
---@return number, number, number
function Volume:position(i, j, k) end

---How many voxels are not 0.
---@return integer
function Volume:count() end

---Write the volume: .nii, .nii.gz, .nrrd, .vol (masks and centre lines) or, of a 2D network, .pgm, by the path's extension.
---@param path string
function Volume:save(path) end

---What `venule.cco{…}` grows with, as its field `engine`: `#c` trees, numbered from 1.
---@class venule.Cco
local Cco = {}

---Add a tree, by the options of one in venule.cco{…} (`root` or `from`, `inflow`, …); its number.
---@param options table
---@return integer
function Cco:add(options) end

---Keep clear of a network that does not grow here: its edges as tubes of their radii.
---@param network venule.Network
function Cco:avoid(network) end

---From now on terminals fall into that part of the domain, until each tree has so many more.
---@param options {domain?: venule.Domain, terminals: integer}
function Cco:stage(options) end

---Add up to n terminals to each tree, in turns; how many came in all. Where no place is found for another: nil, why, and how many came before.
---@param n integer
---@return integer?, string?, integer?
function Cco:grow(n) end

---Whether every tree has the terminals it was to have.
---@return boolean
function Cco:done() end

---A tree as a network of its own, with radius, flow and pressure of the terminals it has now.
---@param tree integer
---@return venule.Network
function Cco:network(tree) end

---What a tree has come to, and what was refused on the way.
---@param tree integer
---@return venule.CcoReport
function Cco:report(tree) end

---Random numbers that depend on nothing but their seed: `venule.rng(7)`.
---@class venule.Rng
local Rng = {}

---The next number in [low, high); without arguments in [0, 1).
---@param low? number
---@param high? number
---@return number
function Rng:uniform(low, high) end

---The next normally distributed number; mean 0 and standard deviation 1 unless given.
---@param mean? number
---@param sd? number
---@return number
function Rng:normal(mean, sd) end

---The next whole number from low to high, both included.
---@param low integer
---@param high integer
---@return integer
function Rng:integer(low, high) end

return venule
