"""Keys of the schema that no shipped scenario has: small scenarios that have them."""
EVERY_KEY = {
    "an earlier result": '''
schema = 1
[model]
name = "expression"
[model.measurands]
y = "a + b + x"
[quantities]
x = { value = "1 um", u = "1 um" }
a = { from = "earlier.h5:y", same = ["x"] }
b = { value = "1 um", components = [{ from = "earlier.h5:y", same = ["x"] }] }
''',
    "distributions": '''
schema = 1
[model]
name = "rod_gauging"
[quantities.laser_z]
components = [
  { name = "a", U = "2 um", k = 2, evaluation = "B", degrees_of_freedom = 9 },
  { distribution = "curvilinear_trapezoid", low = "-2 um", high = "2 um", inexactness = "0.1 um" },
  { distribution = "trapezoid", half_width = "2 um", top_ratio = 0.5 },
  { distribution = "exponential", mean = "1 um" },
  { distribution = "gamma", shape = 2, scale = "1 um" },
  { distribution = "lognormal", median = "1 um", sigma = 0.1 },
  { distribution = "lognormal", mu = -13, sigma = 0.1 },
  { distribution = "discrete", values = ["0 um", "1 um"], probabilities = [0.5, 0.5] },
  { distribution = "empirical", values = { file = "values.csv", column = "r", unit = "um" } },
  { observations = ["0 um", "1 um", "2 um", "1 um"], source = "four" },
]
[quantities]
rod_radius = { distribution = "empirical", values = { file = "values.csv", column = "r", unit = "mm", decimal = ".", where = { r = { not = "9" } } }, unit = "mm" }
rod_length = { distribution = "discrete", values = ["150 mm", "151 mm"], probabilities = [0.5, 0.5], evaluation = "B" }
fillet_radius = { distribution = "lognormal", median = "0.03 mm", sigma = 0.1 }
[indications.spindle_z]
readings = ["-330 mm", "-330.001 mm"]
labels = { rod = "1" }
repeatability = { s = "1 um", degrees_of_freedom = 4, evaluation = "A", source = "declared" }
[[correlations]]
quantities = ["fillet_radius", "rod_length"]
kind = "copula"
matrix = [[1, 0.1], [0.1, 1]]
source = "assumed"
[[expected]]
figure = "standard_uncertainty"
of = "laser_z"
value = "1 um"
labels = { rod = "1" }
[run]
design = "sobol"
max_failed_share = 0.5
store_inputs = true
[analysis]
measurands = ["laser_z"]
[[analysis.conformity]]
measurand = "laser_z"
labels = { rod = "1" }
lower = "-1 m"
guard_factor = 1
[[analysis.conformity]]
measurand = "laser_z"
lower = "-1 m"
rule = "ilac_g8"
[[analysis.targets]]
measurand = "laser_z"
labels = { rod = "1" }
U = "5 um"
[estimate]
loss = "huber"
width = 2
iterations = 100
posterior = "t"
''',
    "pooled": '''
schema = 1
[model]
name = "rod_gauging"
[quantities]
laser_z = { estimated = true, value = "-510 mm" }
[indications.spindle_z]
readings = { file = "values.csv", column = "r", unit = "mm", decimal = "." }
repeatability = { pooled = true, evaluation = "A" }
[run]
adaptive = { digits = 2, validation = true }
[analysis]
sensitivity = { morris = 8 }
[trace]
alpha = 0.01
draws = 99
free = "laser_z"
unconfirmed = ["film"]
jumping = { rod_length = "2 um" }
priors = { rod_length = { value = "330 mm", u = "1 um" } }
[stated_effects.bend]
table = { feed = ["1 mm/min", "9 mm/min"], loading = [0, 1], margin = 0.05, beyond = 0 }
unit = "um"
[stated_effects.film]
formula = "1 / feed"
unit = "um*mm/min"
size = { value = "1 um*mm/min", u = "1 um*mm/min" }
source = "a guess"
[stated_effects.stretch]
quantity = "rod_length"
formula = "feed"
unit = "ms"
''',
    "choose": '''
schema = 1
[model]
name = "expression"
method = "virtual_experiment"
[model.measurands]
length = "z"
[model.indications]
z = "length + feed * delay"
[conditions]
feed = "10 mm/min"
[quantities]
length = "100 mm"
delay = { value = "6 ms", u = "1 ms" }
[choose]
target = "3 um"
target_of = "worst_case"
bias = "10 um"
definition = "uncorrected"
confirm_probability = 0.9
near = 0.2
refinements = 1
sobol = 64
[choose.variables]
feed = ["10 mm/min", "20 mm/min"]
[choose.time]
per_reading = "way / feed"
once = "start"
way = "5 mm"
start = "1 s"
[[choose.cases]]
name = "slow"
values = { delay = "9 ms" }
''',
    "plan": '''
schema = 1
[model]
name = "expression"
[model.indications]
y = "a + b * x"
[conditions]
x = [0, 1, 2]
warmth = 1
[quantities]
a = { estimated = true, value = 0 }
b = { value = 1, u = 0.1 }
[indications.y]
readings = [1, 2, 3]
components = [{ distribution = "normal", u = 1, per = "reading" }]
[stated_effects.scale]
formula = "x"
unit = "1"
[stated_effects.expansion]
formula = "x * warmth"
unit = "1"
[plan]
split = ["scale", "expansion"]
detect = "scale"
sizes = { scale = 1, expansion = 2 }
uncertainties = { a = 0.1 }
most = 30
budget = 25
cost = 2
setup_costs = { x = 1 }
power = 0.8
alpha = 0.05
[plan.readings]
x = { from = 0, to = 3, step = 1 }
warmth = [1, 2]
''',
    "volume": '''
schema = 1
[model]
name = "serial_chain"
method = "virtual_experiment"
measured = "position"
[machine]
name = "TTTRR"
[volume]
X = { from = "0 mm", to = "400 mm", points = 3 }
tool = ["0 mm", "0 mm", "-150 mm"]
payload = "1 kg"
samples = 1000
''',
    "plan by points": '''
schema = 1
[model]
name = "expression"
[model.indications]
y = "a + x"
[conditions]
x = 0
[quantities]
a = { estimated = true, value = 0 }
[indications.y]
readings = [1]
[plan]
points = "points.csv"
most = 3
''',
    "command": '''
schema = 1
[model]
name = "command"
command = ["/usr/bin/python3", "model.py"]
[model.measurands]
y = { unit = "mm", meaning = "a length" }
[quantities]
x = "1 mm"
''',
    "set-points": '''
schema = 1
[model]
name = "expression"
[model.indications]
y = "g * p"
[data]
file = "values.csv"
units = { r = "mm" }
[quantities]
g = { estimated = true, value = 1 }
p = { column = "v", u = "1 um", unit = "mm" }
[indications.y]
readings = "r"
''',
    "data": '''
schema = 1
[model]
name = "expression"
[model.indications]
x = "g * p"
y = "g * p * d"
z = "g * p * s * way"
[data]
file = "values.csv"
delimiter = ","
header = 1
first_row = 2
repeats = "mean"
decimal = "."
labels = { w = "w" }
units = { r = "mm" }
where = { w = ["a", "b"] }
conditions = { s = { column = "w", map = { a = 1, b = -1 } }, p = { column = "r", unit = "mm" }, d = { column = "w", map = { a = 1, b = -1 } }, t = { column = "c", clock = "%H:%M", since = "08:00" }, way = { column = "r", sense = true } }
[quantities]
g = { value = 1, estimated = true }
h = { distribution = "empirical", values = { file = "values.csv", column = "r", unit = "mm", delimiter = ",", header = 1, first_row = 2 } }
[indications.x]
readings = "r"
u = { column = "r", unit = "mm" }
[indications.y]
readings = { column = "r", unit = "mm", where = { w = ["a", "b"] } }
[indications.z]
readings = { file = "values.csv", delimiter = ",", header = 1, first_row = 2, repeats = "mean", column = "r", unit = "mm", labels = { w = "w" }, conditions = { p = { column = "r", unit = "mm" }, d = { column = "w", map = { a = 1, b = -1 } }, t = { column = "c", clock = "%H:%M", since = "08:00" }, s = { column = "w", map = { a = 1, b = -1 } }, way = { column = "r", sense = true } } }
[trace]
blocks = { every = "1 min", of = "t" }
columns = { q = { column = "v", unit = "mm" }, f = { column = "w", map = { a = 1, b = -1 } }, m = { column = "c", clock = "%H:%M", since = "08:00" }, n = { counts = "readings" }, o = { column = "v", sense = true } }
''',
    "logs": '''
schema = 1
[model]
name = "expression"
[model.indications]
x = "g * p"
y = "g * p"
[data]
file = "log.txt"
form = "form.toml"
conditions = { p = "p" }
[quantities]
g = { value = 1, estimated = true }
h = { distribution = "empirical", values = { file = "log.txt", form = "form.toml", column = "v" } }
[indications.x]
readings = "v"
[indications.y]
readings = { file = "log.txt", form = "form.toml", column = "v", conditions = { p = "p" } }
''',
    "counted": '''
schema = 1
[model]
name = "expression"
[model.indications]
x = "g * p"
[data]
file = "values.csv"
conditions = { p = "r" }
[quantities]
g = { value = 1, estimated = true }
[indications.x]
readings = "r"
[trace]
blocks = { count = 2, interleaved = true }
''',
    "machine": '''
schema = 1
[model]
name = "sphere_probing"
method = "virtual_experiment"
[machine]
workpiece_side = ["X", { axis = "B", kind = "rotary", point = ["0 mm", "0 mm", "-400 mm"], sense = 1 }]
tool_side = ["Z", { axis = "Y", kind = "linear", point = ["0 mm", "0 mm", "0 mm"], sense = 1 }]
errors = { E_A0B = "0.01 deg" }
''',
    "robot": '''
schema = 1
[model]
name = "serial_chain"
method = "virtual_experiment"
measured = "distance"
[machine]
workpiece_side = [
  { axis = "A", direction = [1, 1, 0] },
  { axis = "J3", dh = { a = "1 mm", alpha = "90 deg", d = "2 mm", theta = "3 deg" } },
  { axis = "J4", modified_dh = { a = "1 mm", alpha = "90 deg", d = "2 mm", theta = "3 deg" } },
]
tool_side = [
  { axis = "C", direction = [0, 1, 1] },
  { axis = "J1", dh = { a = "1 mm", alpha = "90 deg", d = "2 mm", theta = "3 deg" } },
  { axis = "J2", modified_dh = { a = "1 mm", alpha = "90 deg", d = "2 mm", theta = "3 deg" } },
]
errors = { delta_a_J1 = "0.1 mm" }
''',
    "predefined machine": '''
schema = 1
[model]
name = "serial_chain"
method = "virtual_experiment"
[machine]
name = "TTTRR"
points = { C = ["0 mm", "0 mm", "-50 mm"] }
''',
}
