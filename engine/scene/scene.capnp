# What is simulated. JSON scenes and Cap'n Proto bytes share this schema; docs/scenes.md is generated from it.
#
# The names are those of the structs in scene.hpp. A comment after a field says what it is, `limits` its unit and the values
# allowed, which validate() reads from here. A number whose default is nan is left open: validate() says where it is needed.
@0xc1bbb11aa97bb3bd;

using Cxx = import "/capnp/c++.capnp";
$Cxx.namespace("talus::schema");

struct Limits {
  # What a number, or each number of an array, may be.
  unit @0 :Text = "-";
  low @1 :Float64 = -inf;
  high @2 :Float64 = inf;
  orZero @3 :Bool;
  # 0 is allowed besides.
  slips @4 :List(Slip);
  # Other units that are easily given by mistake: suggested when the value would be allowed in them.
}

struct Slip {
  unit @0 :Text;
  factor @1 :Float64;
  # Size of that unit in the right one.
}

annotation limits @0xe0ee2b2f8ea4d7b7 (field) :Limits;

const pressureSlips :List(Slip) = [(unit = "kPa", factor = 1e3), (unit = "MPa", factor = 1e6), (unit = "GPa", factor = 1e9)];
const inversePressureSlips :List(Slip) = [(unit = "1/kPa", factor = 1e-3), (unit = "1/m", factor = 1.0197e-4)];
const velocitySlips :List(Slip) = [(unit = "cm/s", factor = 1e-2), (unit = "m/h", factor = 2.7778e-4), (unit = "m/d", factor = 1.1574e-5)];
const rainSlips :List(Slip) = [(unit = "m/h", factor = 2.7778e-4), (unit = "mm/h", factor = 2.7778e-7)];
const densitySlips :List(Slip) = [(unit = "g/cm3", factor = 1e3), (unit = "kN/m3", factor = 101.97)];
const fractionSlips :List(Slip) = [(unit = "percent", factor = 1e-2)];
const angleSlips :List(Slip) = [(unit = "radians", factor = 57.296)];
const diffusivitySlips :List(Slip) = [(unit = "cm2/s", factor = 1e-4)];
const lengthSlips :List(Slip) = [(unit = "cm", factor = 1e-2), (unit = "mm", factor = 1e-3)];

struct Scene {
  # The whole scene.
  name @0 :Text;
  # Short name, used for files.
  title @1 :Text;
  # One line for people.
  physics @2 :Physics;
  # What is simulated; left out: water in a deforming ground.
  gravity @3 :Float64 = 9.81 $limits(unit = "m/s2", low = 1e-3, high = 2000, orZero = true);
  # Downwards. 0 in a dry ground only: a conductivity is defined by the weight of water.
  water @4 :Water;
  # The pore water.
  soils @5 :List(Soil);
  # At least one.
  ground @6 :Ground;
  # Required: one of `column`, `section`, `mesh`.
  boundaries @7 :List(Boundary);
  # What holds on the sides of the ground. Where no boundary says anything a side is impermeable and free, but the
  # surface, which takes rain, ponds and seeps.
  surface @8 :Surface;
  # The ground surface and its rain.
  initial @9 :Initial;
  # The state at the start.
  numerics @10 :Numerics;
  # Accuracy.
  schedule @11 :Schedule;
  # What a host does that only follows the scene; other hosts have a clock of their own and need none.
  probes @12 :List(Probe);
  # Places with a history.
  dynamics @13 :Dynamics;
  # How the motion of a dynamic ground is computed.
  gas @14 :Gas;
  # The pore gas, where physics.gas says that it moves.
}

struct Physics {
  # What is simulated; the rest is left out of the engine.
  water @0 :Bool = true;
  # Whether there is pore water; false: a dry ground, which must name no rain, flow or suction.
  deforming @1 :Bool = true;
  # Whether the soil's skeleton moves; false: rigid, and no boundary may say anything on motion.
  stress @2 :StressMeasure = net;
  # The stress that deforms the skeleton and decides on its strength.
  regime @3 :Regime = quasiStatic;
  # How the skeleton moves.
  gas @4 :Bool = false;
  # Whether the pore gas of a dynamic ground that holds water moves and is pressed together; false: its pressure is the atmosphere's.
  exchange @5 :Bool = false;
  # Whether water evaporates into a gas that moves, and air dissolves in the water, each always in equilibrium with the other.
}

enum Regime {
  quasiStatic @0;
  # From equilibrium to equilibrium, without inertia: for ground that stands.
  dynamic @1;
  # By its momentum, with inertia and motion of any size: for ground that fails, slides and comes to rest. So far of plane
  # ground that deforms, between walls: each of `base`, `left` and `right` with a `motion` is a plane wall along an axis, which goes on
  # beyond the ground. Ground that leaves a side without a wall moves freely. Where there is
  # water it has a velocity of its own; the surface takes rain and lets water out, all other sides are closed as soon as the ground moves.
  auto @2;
  # Quasi-static until equilibrium is lost, dynamic from there until the ground rests, then quasi-static again on a mesh under its surface as it lies by then; what is said of both
  # holds. Ground whose gas moves, or that has come to be thinner than a cell of the grid somewhere between its sides, stays as it came to rest.
}

enum StressMeasure {
  net @0;
  # Total stress plus the larger of the water's and the air's pressure.
  bishop @1;
  # Total stress plus the mean pore pressure, weighted by the effective saturation.
}

struct Water {
  # The pore water: density rho = density exp(p / bulkModulus).
  density @0 :Float64 = 1000 $limits(unit = "kg/m3", low = 500, high = 2000, slips = .densitySlips);
  # At zero pressure.
  bulkModulus @1 :Float64 = 2e9 $limits(unit = "Pa", low = 1e5, high = 1e15, slips = .pressureSlips);
  # Lower where the water holds air bubbles.
}

struct Gas {
  # The pore gas: ideal, at one temperature, in the ground's surface at the pressure of the atmosphere. The defaults are those of air at 20 degrees.
  density @0 :Float64 = 1.2041 $limits(unit = "kg/m3", low = 0.01, high = 100);
  # At the pressure of the atmosphere.
  viscosityRatio @1 :Float64 = 0.018 $limits(low = 1e-4, high = 10);
  # Its viscosity over the water's.
  atmosphere @2 :Float64 = 101325 $limits(unit = "Pa", low = 1e3, high = 1e8, slips = .pressureSlips);
  # Absolute pressure of the atmosphere.
  temperature @3 :Float64 = 293.15 $limits(unit = "K", low = 273.15, high = 323.15);
  # Of the ground and the atmosphere. This and what follows is of physics.exchange alone: the gas is then air and vapour, and the numbers above are the dry air's.
  henryConstant @4 :Float64 = 7.8e-6 $limits(unit = "mol/(m3 Pa)", low = 1e-10, high = 1e-2);
  # Air dissolved in water, per partial pressure of the air.
  vapourDiffusivity @5 :Float64 = 2.4e-5 $limits(unit = "m2/s", low = 1e-9, high = 1e-2, slips = .diffusivitySlips);
  # Of vapour in air.
  airDiffusivity @6 :Float64 = 2e-9 $limits(unit = "m2/s", low = 1e-12, high = 1e-6, orZero = true, slips = .diffusivitySlips);
  # Of dissolved air in water.
  humidity @7 :Float64 = 1 $limits(low = 0, high = 1, slips = .fractionSlips);
  # Relative humidity of the atmosphere.
}

struct Soil {
  # A soil: what layers and cells are made of.
  name @0 :Text;
  # Required, and not shared with another soil.
  dryDensity @1 :Float64 = nan $limits(unit = "kg/m3", low = 100, high = 5000, slips = .densitySlips);
  # Dry bulk density: grains per volume of soil. Required where the skeleton deforms.
  porosity @2 :Float64 = nan $limits(low = 0.01, high = 0.95, slips = .fractionSlips);
  # Pore volume per volume of soil. Required.
  hydraulics @3 :Hydraulics;
  # How it holds and conducts water. Required where there is water.
  solid @4 :Solid;
  # How its skeleton deforms and fails. Required where the skeleton deforms.
}

struct Hydraulics {
  # How a soil holds and conducts water.
  retention @0 :Retention;
  # How much water it holds.
  relativePermeability @1 :RelativePermeability;
  # How its conductivity falls as it dries.
  conductivity @2 :Conductivity;
  # Its conductivity when full.
}

struct Retention {
  # Saturation S = residualSaturation + (maximumSaturation - residualSaturation) S_e(s) at a suction s.
  model @0 :RetentionModel = vanGenuchten;
  # The curve S_e(s).
  alpha @1 :Float64 = nan $limits(unit = "1/Pa", low = 1e-8, high = 1e-2, slips = .inversePressureSlips);
  # Inverse of the air-entry suction. Required but for `tabulated`.
  n @2 :Float64 = nan $limits(low = 0.01, high = 20);
  # Exponent. Required for `vanGenuchten`, where it is at least 1.01, and for `brooksCorey`.
  residualSaturation @3 :Float64 = 0 $limits(low = 0, high = 0.99, slips = .fractionSlips);
  # Saturation at infinite suction.
  maximumSaturation @4 :Float64 = 1 $limits(low = 0.01, high = 1, slips = .fractionSlips);
  # Saturation without suction.
  suction @5 :List(Float64) $limits(unit = "Pa", low = 0, high = 1e10);
  # For `tabulated`: increasing from 0.
  saturation @6 :List(Float64) $limits(low = 0, high = 1, slips = .fractionSlips);
  # For `tabulated`: one a suction, not increasing.
}

enum RetentionModel {
  vanGenuchten @0;
  # S_e = [1 + (alpha s)^n]^-(1 - 1/n).
  gardner @1;
  # S_e = exp(-alpha s).
  brooksCorey @2;
  # S_e = min(1, (alpha s)^-n); 1/alpha is the air-entry suction.
  tabulated @3;
  # Monotone cubic through (suction, saturation), constant beyond its ends.
}

struct RelativePermeability {
  # The conductivity of a soil over its conductivity when full, at a suction s.
  model @0 :PermeabilityModel = mualem;
  # The curve k_r(s).
  poreConnectivity @1 :Float64 = 0.5 $limits(low = -10, high = 20);
  # Exponent l of `mualem` and `brooksCorey`.
  alpha @2 :Float64 = nan $limits(unit = "1/Pa", low = 1e-8, high = 1e-2, slips = .inversePressureSlips);
  # Required for `gardner`.
  exponent @3 :Float64 = nan $limits(low = 0.01, high = 100);
  # Required for `power`.
  suction @4 :List(Float64) $limits(unit = "Pa", low = 0, high = 1e10);
  # For `tabulated`: increasing from 0.
  relativePermeability @5 :List(Float64) $limits(low = 0, high = 1, slips = .fractionSlips);
  # For `tabulated`: one a suction, not increasing.
}

enum PermeabilityModel {
  mualem @0;
  # S_e^l [1 - (1 - S_e^{1/m})^m]^2 with m = 1 - 1/n of the soil's `vanGenuchten` retention.
  constant @1;
  # 1.
  gardner @2;
  # exp(-alpha s).
  power @3;
  # S_e^exponent.
  brooksCorey @4;
  # S_e^(2/n + l + 2) with n of the soil's `brooksCorey` retention.
  tabulated @5;
  # Monotone cubic through (suction, relativePermeability), constant beyond its ends.
}

struct Conductivity {
  # Saturated hydraulic conductivity.
  along @0 :Float64 = nan $limits(unit = "m/s", low = 1e-20, high = 0.3, slips = .velocitySlips);
  # Along the bedding. Required.
  across @1 :Float64 = nan $limits(unit = "m/s", low = 1e-20, high = 0.3, slips = .velocitySlips);
  # Across the bedding; left out: the same as along.
  dip @2 :Float64 = 0 $limits(unit = "degrees", low = -90, high = 90);
  # Angle of the bedding from the x axis, counter-clockwise; ground that moves keeps it.
  porosityDependence @3 :PorosityDependence = none;
  # How it follows the porosity as the skeleton deforms.
}

enum PorosityDependence {
  none @0;
  # Not at all.
  kozenyCarman @1;
  # In proportion to n^3 / (1 - n)^2.
}

struct Solid {
  # How a soil's skeleton deforms and fails.
  model @0 :SolidModel = mohrCoulomb;
  # The law.
  youngModulus @1 :Float64 = nan $limits(unit = "Pa", low = 2e4, high = 1e15, slips = .pressureSlips);
  # Required.
  poissonRatio @2 :Float64 = nan $limits(low = 0, high = 0.4999);
  # Required.
  strength @3 :Strength;
  # Required for `mohrCoulomb`.
  dilationAngle @4 :Float64 = 0 $limits(unit = "degrees", low = 0, high = 60);
  # At most the friction angle.
  tensileStrength @5 :Float64 = inf $limits(unit = "Pa", low = 0, high = inf);
  # Largest tensile principal stress; left out: as much as the cone of Mohr-Coulomb bears.
  softening @6 :Softening;
  # How its strength falls with slip, for `mohrCoulomb` in a ground whose regime is dynamic or auto.
  inertialFriction @7 :InertialFriction;
  # How its friction grows with the rate of shear, for `mohrCoulomb` in a dynamic ground.
}

struct Softening {
  # Cohesion and friction fall from those of the strength to residual ones, in proportion to the slip on a shear band, and stay there.
  # The slip is the plastic shear strain times sqrt(3) times the size of a cell, so that what a band dissipates does not depend on that.
  # What slip takes (of the friction angle, off its sine) does not depend on the suction.
  residualCohesion @0 :Float64 = nan $limits(unit = "Pa", low = 50, high = 1e10, orZero = true, slips = .pressureSlips);
  # Required, at most the cohesion.
  residualFrictionAngle @1 :Float64 = nan $limits(unit = "degrees", low = 1, high = 60, orZero = true, slips = .angleSlips);
  # Required, at most the friction angle.
  slip @2 :Float64 = nan $limits(unit = "m", low = 1e-6, high = 1e3, slips = .lengthSlips);
  # Required: slip at which the strength is the residual one.
}

struct InertialFriction {
  # Friction of dense granular flow, mu(I) of Jop, Forterre & Pouliquen (2006): the friction angle's sine grows with the inertial number
  # I = rate of shear times grain diameter over sqrt(pressure / density of the grains), from that of the strength towards that of the limit.
  limitFrictionAngle @0 :Float64 = nan $limits(unit = "degrees", low = 1, high = 80, slips = .angleSlips);
  # Required, at least the friction angle: that at a boundless rate.
  inertialNumber @1 :Float64 = 0.279 $limits(low = 1e-3, high = 1e3);
  # I at which half of the way is gone; left out: that of glass beads.
  grainDiameter @2 :Float64 = nan $limits(unit = "m", low = 1e-6, high = 10, slips = .lengthSlips);
  # Required.
}

enum SolidModel {
  elastic @0;
  # Linear elastic; it must name no strength.
  mohrCoulomb @1;
  # Linear elastic and perfectly plastic.
}

struct Strength {
  # Cohesion and friction angle at a suction s.
  model @0 :StrengthModel = vanapalli;
  # How they grow with suction.
  cohesion @1 :Float64 = nan $limits(unit = "Pa", low = 50, high = 1e10, orZero = true, slips = .pressureSlips);
  # Cohesion c without suction. Required.
  frictionAngle @2 :Float64 = nan $limits(unit = "degrees", low = 1, high = 60, orZero = true, slips = .angleSlips);
  # Friction angle phi without suction. Required.
  suctionFrictionAngle @3 :Float64 = 0 $limits(unit = "degrees", low = 1, high = 60, orZero = true, slips = .angleSlips);
  # Required for `fredlund`, and above 0 there.
  cohesionGain @4 :Float64 = 0 $limits(unit = "Pa", low = 50, high = 1e10, orZero = true, slips = .pressureSlips);
  # For `exponential`: largest gain of cohesion by suction. This or frictionGain must be above 0.
  cohesionRate @5 :Float64 = 0 $limits(low = 0, high = 1000);
  # For `exponential`: how fast cohesion is gained. Required with a cohesionGain.
  frictionGain @6 :Float64 = 0 $limits(unit = "degrees", low = 0, high = 60);
  # For `exponential`: gain of friction angle by a suction of one atmosphere.
}

enum StrengthModel {
  constant @0;
  # c, phi.
  fredlund @1;
  # c + s tan(suctionFrictionAngle), phi.
  vanapalli @2;
  # c + s S_e tan(phi), phi.
  exponential @3;
  # c + cohesionGain [1 - exp(-cohesionRate s / p_atm)], phi + frictionGain s / p_atm.
}

struct Ground {
  # The ground: exactly one of these.
  union {
    column @0 :ColumnGround;
    # A vertical column, one-dimensional.
    section @1 :SectionGround;
    # A vertical section in plane strain, described by its layers.
    mesh @2 :MeshGround;
    # A vertical section in plane strain, described by a mesh.
  }
}

struct ColumnGround {
  # A vertical column of cells from y = 0 up. Its sides are `base` and `surface`.
  height @0 :Float64 = nan $limits(unit = "m", low = 1e-3, high = 1e5);
  # Required.
  cells @1 :Int32 $limits(low = 1, high = 1000000);
  # Required.
  layers @2 :List(ColumnLayer);
  # From top to bottom; at least one, none thinner than a cell.
}

struct ColumnLayer {
  # A layer, down to the next one's top or the base.
  soil @0 :Text;
  # Required: the name of a soil.
  top @1 :Float64 = nan $limits(unit = "m", low = 0, high = 1e5);
  # Height of its top above the base. The first layer's may be left out: it is the column's height.
}

struct SectionGround {
  # A vertical section between a terrain profile and a base. Its sides are `base`, `left`, `right` and `surface`.
  # Profiles are lists of places [x, y] in m, with x increasing, joined by straight lines.
  terrain @0 :List(List(Float64)) $limits(unit = "m", low = -1e5, high = 1e5);
  # Profile of the ground surface, from the left side to the right one. Required.
  base @1 :List(List(Float64)) $limits(unit = "m", low = -1e5, high = 1e5);
  # Profile of the base, from the left side to the right one, below the terrain. Required.
  layers @2 :List(SectionLayer);
  # From top to bottom; at least one.
  columnWidth @3 :Float64 = nan $limits(unit = "m", low = 1e-4, high = 1e5);
  # Largest width of a column of cells. Required.
  surfaceCellHeight @4 :Float64 = nan $limits(unit = "m", low = 1e-4, high = 1e5);
  # Height of the uppermost cells. Required.
  gradedDepth @5 :Float64 = 0 $limits(unit = "m", low = 0, high = 1e5);
  # Down to this depth cells have surfaceCellHeight.
  growth @6 :Float64 = nan $limits(low = 1, high = 4);
  # Ratio of a cell's height to that of the cell above it, below gradedDepth. Left out: heights grow evenly with the depth, and are
  # largestCellHeight at the greatest depth; columns widen evenly away from bends, and are columnWidth wide where bends are farthest.
  largestCellHeight @7 :Float64 = nan $limits(unit = "m", low = 1e-4, high = 1e5);
  # Required, at least surfaceCellHeight.
  bendColumnWidth @8 :Float64 = nan $limits(unit = "m", low = 1e-4, high = 1e5);
  # Width of the columns beside a bend of the terrain, at most columnWidth; farther away they widen by the ratio `growth`.
  # Left out: columnWidth.
}

struct SectionLayer {
  # A layer, down to the next one's top or the base.
  soil @0 :Text;
  # Required: the name of a soil.
  top @1 :List(List(Float64)) $limits(unit = "m", low = -1e5, high = 1e5);
  # Profile of its top over the section's whole width. It may touch the profiles above and below it, where a layer ends,
  # but not cross them. Left out of the first layer: its top is the terrain.
}

struct MeshGround {
  # A mesh of triangles and quads: a file or the arrays.
  file @0 :Text;
  # A Gmsh file, version 2.2 or 4.1, ASCII, sought in the folder of the scene's file (of a scene from memory: in the host's
  # working directory). Its physical surfaces have names of soils; its physical lines may name more
  # sides than `base`, `left`, `right` and `surface`.
  position @1 :List(Float64) $limits(unit = "m", low = -1e5, high = 1e5);
  # x, y of each node.
  cellStart @2 :List(Int32);
  # Where each cell's nodes start in cellNodes, and the end: one more than there are cells.
  cellNodes @3 :List(Int32);
  # Numbers of the nodes, from 0, counter-clockwise around each cell.
  cellSoil @4 :List(Int32);
  # Number of each cell's soil in the scene's list, from 0.
}

struct Boundary {
  # What holds on a side or a part of it: on the flow, on the motion, or on both.
  name @0 :Text;
  # For messages and for changes in time. Two boundaries may not share one.
  side @1 :Text;
  # Required: `base`, `left`, `right`, `surface` or a physical line of the mesh file.
  xFrom @2 :Float64 = -inf $limits(unit = "m");
  # The part of the side between these coordinates; left out: all of it.
  xTo @3 :Float64 = inf $limits(unit = "m");
  # See xFrom.
  yFrom @4 :Float64 = -inf $limits(unit = "m");
  # See xFrom.
  yTo @5 :Float64 = inf $limits(unit = "m");
  # See xFrom.
  flow @6 :FlowCondition = unspecified;
  # What holds on the flow of water.
  flowValue @7 :Series;
  # Required for `pressure` (Pa), `hydrostatic` (elevation of the water table, m) and `flux` (inflow, m/s).
  motion @8 :MotionCondition = unspecified;
  # What holds on the motion of the skeleton.
  motionX @9 :Series;
  # For `displacement` (m) and `traction` (Pa): along x; left out: free in this direction.
  motionY @10 :Series;
  # For `displacement` (m) and `traction` (Pa): along y; left out: free in this direction.
  frictionAngle @11 :Float64 = nan $limits(unit = "degrees", low = 1, high = 60, orZero = true, slips = .angleSlips);
  # Required for `friction`.
}

enum FlowCondition {
  unspecified @0;
  # The boundary says nothing on the flow.
  impermeable @1;
  # No flow through the side.
  pressure @2;
  # The pore pressure is flowValue, Pa.
  hydrostatic @3;
  # The pore pressure is that below and above a water table at the elevation flowValue, m.
  flux @4;
  # The inflow normal to the side is flowValue, m/s; negative: outflow.
  surface @5;
  # Rain, ponding and seepage, as on the ground surface.
}

enum MotionCondition {
  unspecified @0;
  # The boundary says nothing on the motion.
  free @1;
  # No traction.
  roller @2;
  # No displacement normal to the side, no traction along it.
  fixed @3;
  # No displacement.
  displacement @4;
  # The displacement since the start is motionX, motionY, m.
  traction @5;
  # The traction is motionX, motionY, Pa.
  friction @6;
  # A wall of a dynamic ground, which the ground may leave and slide along, held by Coulomb's friction of the angle frictionAngle under what
  # presses the skeleton on it: suction adds nothing to that. Water slides along it. In the equilibrium at the start it holds as `fixed` on the
  # base, as `roller` on the left and the right.
}

struct Series {
  # A value in time: linear between the times, constant before the first and after the last.
  time @0 :List(Float64) $limits(unit = "s", low = -1e11, high = 1e11);
  # Increasing. May be left out where there is one value.
  value @1 :List(Float64) $limits(low = -1e12, high = 1e12);
  # One a time.
}

struct Surface {
  # The ground surface and its rain.
  pondingDepth @0 :Float64 = 0 $limits(unit = "m", low = 0, high = 10, slips = .lengthSlips);
  # Water that the surface may hold before it runs off.
  zones @1 :List(RainZone);
  # Parts of the surface with a rain of their own; the rest has none. They may not overlap.
}

struct RainZone {
  # Rain on a part of the ground surface: a volume per horizontal area. rate[k] holds from time[k] to time[k + 1].
  name @0 :Text;
  # For messages. Two zones may not share one.
  xFrom @1 :Float64 = -inf $limits(unit = "m");
  # The zone's left end; left out: that of the surface.
  xTo @2 :Float64 = inf $limits(unit = "m");
  # The zone's right end; left out: that of the surface.
  time @3 :List(Float64) $limits(unit = "s", low = -1e11, high = 1e11);
  # Increasing. Times and rates may be left out where the host pushes the rain.
  rate @4 :List(Float64) $limits(unit = "m/s", low = 0, high = 1e-3, slips = .rainSlips);
  # One a time; 1e-3 m/s are 3600 mm/h.
  rainEnd @5 :Float64 = nan $limits(unit = "s", low = -1e11, high = 1e11);
  # The rain is known until here: a step past it is done with the last rate and said aloud. Left out: the last rate holds
  # for ever.
}

struct Initial {
  # The state at the start.
  flow @0 :InitialFlow = hydrostatic;
  # The pore pressure.
  suction @1 :Float64 = nan $limits(unit = "Pa", low = 0, high = 1e9);
  # Required for `suction`: uniform.
  saturation @2 :Float64 = nan $limits(low = 0, high = 1, slips = .fractionSlips);
  # Required for `saturation`: uniform, between the residual and the maximum saturation of every soil.
  waterTable @3 :Float64 = nan $limits(unit = "m", low = -1e6, high = 1e6);
  # Required for `hydrostatic`: elevation of the water table.
  surfacePressure @4 :Float64 = nan $limits(unit = "Pa", low = -1e9, high = 1e9);
  # For `steady`: held on the ground surface. Either this or surfaceRain.
  surfaceRain @5 :Float64 = nan $limits(unit = "m/s", low = 0, high = 1e-3, slips = .rainSlips);
  # For `steady`: rain on the ground surface. Either this or surfacePressure.
  stress @6 :InitialStress = gravity;
  # The stress, where the skeleton deforms.
  k0 @7 :Float64 = nan $limits(low = 0, high = 10);
  # Required for `k0`: ratio of the horizontal to the vertical stress (net or Bishop's, as physics.stress says).
}

enum InitialFlow {
  suction @0;
  # The same suction everywhere.
  saturation @1;
  # The same saturation everywhere.
  hydrostatic @2;
  # Water at rest with a water table.
  steady @3;
  # The steady state under the boundaries and what is held on the ground surface.
}

enum InitialStress {
  gravity @0;
  # Equilibrium found by turning gravity on. A ground that does not stand has none.
  k0 @1;
  # Vertical stress from the weight above, horizontal stress by its ratio; brought into equilibrium, but in a dynamic ground.
  zero @2;
  # None.
  elastic @3;
  # Gravity turned on elastically: for a dynamic ground, which need not stand. What its strength does not bear is let go in the
  # first moment.
}

struct Numerics {
  # Accuracy.
  tolerance @0 :Float64 = 1e-3 $limits(low = 1e-12, high = 0.1);
  # Error allowed in saturation per unit of its range, and in pressure relative to the scene's own.
}

struct Dynamics {
  # The background grid of a dynamic ground, and its material points, two a cell and direction.
  cellSize @0 :Float64 = nan $limits(unit = "m", low = 1e-4, high = 1e3, slips = .lengthSlips);
  # Width and height of a cell. Required for a dynamic ground. Taken a little smaller where `left` and `right` are walls, so that they lie a
  # whole number of cells apart.
  restSpeed @1 :Float64 = nan $limits(unit = "m/s", low = 1e-9, high = 10);
  # What has been slower than this for 1000 substeps, solid and water, with all that lies up to 8 cells away, is held, as it lies and with its
  # stress and water, until something near it moves faster; it takes next to no time, and rain on it runs off. Ground that is still gaining speed may
  # be held for good if this is too large. Not where gas moves. Left out: nothing is held.
  xFrom @2 :Float64 = -inf $limits(unit = "m");
  # Ends of the background, between which the ground must lie at the start: what becomes of ground that comes to one says `atEnds`. Not on a side
  # that is a wall. Left out: the background has no end there.
  xTo @3 :Float64 = inf $limits(unit = "m");
  # See xFrom.
  yFrom @4 :Float64 = -inf $limits(unit = "m");
  # See xFrom.
  yTo @5 :Float64 = inf $limits(unit = "m");
  # See xFrom.
  atEnds @6 :EndPolicy = extend;
  # What happens there. In every case it is an event.
}

enum EndPolicy {
  extend @0;
  # The background grows with the ground: it goes on.
  absorb @1;
  # Material points that pass an end are taken out, with their mass and their water, which counts as drained.
  stop @2;
  # A smooth wall, which the ground may leave again. At `yTo` up to a cell beyond it, so that it lies a whole number of cells above the base.
}

struct Schedule {
  # What a host does that only follows the scene.
  duration @0 :Float64 = nan $limits(unit = "s", low = 1e-6, high = 1e11);
  # Simulated time.
  step @1 :Float64 = nan $limits(unit = "s", low = 1e-9, high = 1e11);
  # The host's step; at most the duration.
  outputs @2 :List(Float64) $limits(unit = "s", low = 0, high = 1e11);
  # Times of the field files, increasing, at most the duration.
  motionStep @3 :Float64 = nan $limits(unit = "s", low = 1e-9, high = 1e11);
  # While ground of the regime auto moves: the host's step, after each of which the fields are written. Left out: nothing changes as it moves.
}

struct Probe {
  # A place with a history of all fields.
  name @0 :Text;
  # Required, and not shared with another probe.
  place @1 :List(Float64) $limits(unit = "m", low = -1e5, high = 1e5);
  # [x, y] inside the ground; x is 0 in a column.
}
