"""A design as the files that `gumshoe trace` reads."""
import json


def readings_csv(d, y, outputs):
    """`y` in um, written in mm to a tenth of a nanometre."""
    head = ["reading", *d.labels, *(column(n, u) for n, (_, u) in {**d.conditions, **d.columns}.items()), *(f"{o}_mm" for o in outputs)]
    beside = [v for v, _ in {**d.conditions, **d.columns}.values()]
    rows = [",".join([str(i + 1), *(str(l[i]) for l in d.labels.values()), *(repr(float(v[i])) for v in beside),
                      *(f"{x / 1e3:.7f}" for x in y[i])]) for i in range(d.readings)]
    return ",".join(head) + "\n" + "\n".join(rows) + "\n"


def column(name, unit):
    plain = unit.replace("/", "_per_")
    return name if unit == "1" else f"{name}_{plain}"


def number(value, unit):
    text = f"{value:.10g}"
    return text if unit == "1" else f'"{text} {unit}"'


def scenario_toml(d, system):
    out = [(system.header(d) if hasattr(system, "header") else system.HEADER).rstrip() + "\n"]
    labels = ", ".join(f'{n} = "{n}"' for n in d.labels)
    conditions = ", ".join(f'{n} = {{ column = "{column(n, u)}", unit = "{u}" }}' for n, (_, u) in d.conditions.items())
    for output in system.OUTPUTS:
        out.append(f'[indications.{output}]\nreadings = {{ file = "readings.csv", column = "{output}_mm", unit = "mm", '
                   f'labels = {{ {labels} }}, conditions = {{ {conditions} }} }}\n'
                   + (f'components = [ {{ distribution = "normal", u = "{d.noise:g} um", per = "reading" }} ]\n' if d.declared else "")
                   + (f'resolution = "{d.resolution:g} um"\n' if d.resolution else ""))
    for name in dict.fromkeys(c.name for c in d.cells):
        out.append(quantity([c for c in d.cells if c.name == name]))
    if d.scatter:
        out.append(system.scatter_toml(d))
    out.append("[trace]\n" + "\n".join([f'blocks = "{d.blocks}"', f"final  = {json.dumps(list(d.final))}" if d.final else "# final: left to the program",
                                      'order  = "time"', f"redone = {json.dumps([list(r) for r in d.redone])}"]) + "\n")
    if d.columns:
        out.append("[trace.columns]\n" + "".join(f'{n} = {{ column = "{column(n, u)}", unit = "{u}" }}\n' for n, (_, u) in d.columns.items()))
    out.append((system.stated(d) if hasattr(system, "stated") else getattr(system, "STATED", "")).lstrip())
    return "\n".join(out)


def quantity(cells):
    first = cells[0]
    estimated = "estimated = true\n" if first.free else ""
    if not first.label:
        u = "" if first.free or not first.u else f"u     = {number(first.u, first.unit)}\n"
        return f"[quantities.{first.name}]\n{estimated}value = {number(first.value, first.unit)}\n{u}"
    rows = "".join(f'"{c.level}" = {{ value = {number(c.value, c.unit)}' + ("" if c.free or not c.u else f", u = {number(c.u, c.unit)}") + " }\n"
                   for c in cells)
    head = f"[quantities.{first.name}]\n{estimated}" if estimated else ""
    return f"{head}[quantities.{first.name}.by.{first.label}]\n{rows}"


def reclamp(d):
    """Declares that clampings scatter."""
    per = ", ".join(f'"{l}"' for l in d.redone[0])
    return f'[effects.reclamp]\nshift = {{ value = "0 um", u = "{d.scatter:g} um", per = [{per}] }}\n'
