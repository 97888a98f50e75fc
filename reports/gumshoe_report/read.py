"""The result file as plain Python: attributes, and one list of rows per table (engine/store/README.md)."""
import types

import h5py
import numpy as np

from . import record


class NotAResult(Exception):
    """The message names the file, what is wrong with it and what would be right."""


def plain(value):
    """Texts with U+FFFD for what is not UTF-8 (a file may have such a name); numbers as those of Python."""
    if isinstance(value, str):  # as h5py decodes it
        value = value.encode("utf-8", "surrogateescape")
    if isinstance(value, bytes):
        return value.decode("utf-8", "replace")
    return value.item() if isinstance(value, np.generic) else value


def is_dimension(dataset):
    return bytes(dataset.attrs.get("NAME", b"")).startswith(b"This is a netCDF dimension but not")


def rows(group, dimension=None):
    """The columns along one dimension, turned into rows (of a matrix: row by row); without `dimension` that of the
    column `name`. Columns along others (histograms) are left out."""
    if group is None:
        return []
    columns = {name: d for name, d in group.items() if isinstance(d, h5py.Dataset) and not is_dimension(d)}
    if not columns:
        return []
    if dimension is None:
        dimension = columns["name" if "name" in columns else next(iter(columns))].dims[0].label
    values = {n: d[()] for n, d in columns.items() if d.dims[0].label == dimension}
    return [types.SimpleNamespace(**{n: plain(v[i]) for n, v in values.items()})
            for i in range(min(map(len, values.values()), default=0))]


def attributes(group):
    return {k: plain(v) for k, v in group.attrs.items()}


def numbered(group, dimension=None):
    """Sub-groups 000, 001, ...: their attributes and their rows."""
    return [types.SimpleNamespace(**attributes(group[name]), rows=rows(group[name], dimension))
            for name in sorted(group or ())]


def studies(file, r):
    """What a run holds beyond the plain summary and budget; empty where it was not asked for."""
    r.sensitivities = numbered(file.get("sensitivity"))
    for k, study in enumerate(r.sensitivities):
        study.pairs = rows(file.get(f"sensitivity/{k:03d}/pairs"))
        study.confidence = getattr(study, "confidence", 0.95)
    for name in ("shapley", "given_data", "morris", "dgsm", "joint", "fit"):
        setattr(r, name, numbered(file.get(name)))
    r.targets = numbered(file.get("target"))
    r.one_at_a_time = numbered(file.get("one_at_a_time"), "row")
    for k, table in enumerate(r.one_at_a_time):
        table.outputs = [types.SimpleNamespace(**{n.removeprefix("output_"): v for n, v in vars(o).items()})
                         for o in rows(file[f"one_at_a_time/{k:03d}"], "output")]
    r.circular = rows(file.get("circular"))
    r.conformity = rows(file.get("conformity"))
    r.stopping = types.SimpleNamespace(**attributes(file["stopping"]), rows=rows(file["stopping"])) \
        if "stopping" in file else None


def choice(group):
    """What `gumshoe choose` found; None of a run."""
    if group is None:
        return None
    c = types.SimpleNamespace(**attributes(group), evaluations=texts(group, "evaluations"),
                              skipped_why=texts(group, "skipped_why"))
    for name in ("variables", "cases", "candidates", "fresh", "neighbours"):
        setattr(c, name, rows(group.get(name)))
    studies(group, c)
    return c


def columns(group):
    """Datasets of one group by name: `values` as a list, and their attributes."""
    return {n: types.SimpleNamespace(**attributes(d), values=[plain(v) for v in d[()]])
            for n, d in (group or {}).items() if isinstance(d, h5py.Dataset) and not is_dimension(d)}


def in_order(keys, names):
    """Columns in the order of these names; a file has them by the alphabet."""
    return {n: keys[n] for n in sorted(keys, key=lambda n: names.index(n) if n in names else len(names))}


def finding(group):
    depends_on = texts(group, "depends_on")
    return types.SimpleNamespace(
        **attributes(group), **{n: texts(group, n) for n in ("members", "depends_on", "remarks")},
        quantities=rows(group.get("quantities")), curves=numbered(group.get("curves"), "point"),
        tables=[types.SimpleNamespace(**attributes(g), keys=in_order(columns(g["keys"]), depends_on), rows=rows(g, "cell"))
                for _, g in sorted(group.get("tables", {}).items())])


def rounds(group):
    """What each round of `gumshoe trace --loop` added, in its order."""
    return [types.SimpleNamespace(**attributes(one), added=texts(one, "added"), candidates=rows(one.get("candidates")))
            for _, one in sorted((group or {}).items())]


def trace(file):
    """What `gumshoe trace` found; None of another file."""
    group, data = file.get("trace"), file.get("data")
    if group is None:
        return None
    return types.SimpleNamespace(
        **attributes(group), rms=types.SimpleNamespace(**attributes(group["rms"])),
        noise=types.SimpleNamespace(**attributes(group["noise"])),
        lack_of_fit=types.SimpleNamespace(**attributes(group["lack_of_fit"]), depends_on=texts(group["lack_of_fit"], "depends_on")),
        of_indications=rows(group.get("of_indications"), "indication"),
        anomalous_blocks=rows(group.get("anomalous_blocks"), "anomalous_block"),
        outliers=rows(group.get("outliers"), "outlier"),
        findings=[finding(group["findings"][k]) for k in sorted(group.get("findings", ()))],
        candidates=rows(group.get("candidates")), limits=rows(group.get("detection_limits"), "limit"),
        rounds=rounds(file.get("rounds")), plain=texts(group, "plain"), statements=texts(group, "statements"), residuals=rows(file["residuals"]),
        **attributes(file["residuals"]), before=numbered(file.get("budget_before")),
        after=numbered(file.get("budget_after")),
        data=types.SimpleNamespace(**{n: columns(data[n]) for n in ("labels", "conditions", "indications", "columns")}))


def volume(group):
    """What `gumshoe volume` found; None of another file."""
    if group is None:
        return None
    return types.SimpleNamespace(**attributes(group), axes=rows(group["axes"]), points=rows(group["points"]), shares=rows(group.get("causes")))


def texts(file, name):
    return [plain(t) for t in file[name][()]] if name in file else []


def result(path):
    """Everything but the samples of a finished run. Throws NotAResult."""
    if not path.exists():
        raise NotAResult(f"'{path}' does not exist.")
    try:
        with open(path, "rb") as file:
            if file.read(8) != b"\x89HDF\r\n\x1a\n":
                raise NotAResult(f"'{path}' is not a Gumshoe result (it is not an HDF5 file).")
        record.check(path)
        file = h5py.File(path, "r")
    except (OSError, record.Damaged) as problem:
        raise NotAResult(f"'{path}' is not a Gumshoe result that can be read ({problem}).") from None
    with file:
        r = types.SimpleNamespace(**{k: plain(v) for k, v in file.attrs.items()}, path=path)
        if getattr(r, "program", "") != "gumshoe":
            raise NotAResult(f"'{path}' is not a Gumshoe result (another program made it).")
        if not r.complete:
            if hasattr(r, "shard"):
                raise NotAResult(f"'{path}' holds a part of a run (shard {r.shard}). "
                                 "Join all shards with gumshoe merge.")
            done = int(file["samples_done"][0])
            raise NotAResult(f"'{path}' is not finished ({done} of {r.samples} samples). "
                             "Repeat the same run command to resume it.")
        r.outputs = rows(file.get("summary"))
        for k, output in enumerate(r.outputs):
            for key in ("histogram", "histogram_edges"):
                name = f"summary/{key}_{k:03d}"
                setattr(output, key, file[name][()] if name in file else np.zeros(0))
        r.budgets = numbered(file.get("budget"))
        studies(file, r)
        r.choice = choice(file.get("choice"))
        r.trace = trace(file)
        r.volume = volume(file.get("volume"))
        r.validations = rows(file.get("validation"))
        r.comparisons = rows(file.get("comparison"))
        r.printed = rows(file.get("printed"))
        r.inputs = rows(file.get("inputs"))
        r.equations, r.axes = rows(file.get("equations"), "equation"), rows(file.get("machine"))
        r.readings = rows(file.get("readings"))
        readings = file.get("readings")
        r.reading_units = {n: plain(d.attrs.get("units", "1")) for n, d in readings.items()} if readings else {}
        r.reading_display = {n: types.SimpleNamespace(**attributes(d)) for n, d in (readings or {}).items()
                             if "display_units" in d.attrs}
        r.failures, r.notes = texts(file, "failures"), texts(file, "notes")
    return r
