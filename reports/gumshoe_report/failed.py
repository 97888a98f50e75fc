"""What failed samples do to the results: a sample without a value counts for no output."""
from .rounding import of_all, percent, thousands

NOTABLE = 1e-3  # share of failed samples from which they may be why a budget and the samples differ


def total(o):
    return o.valid + o.failed


def condition(o, several):
    """What the stated distribution of an output is conditional on; "" if no sample failed. `several`: whether the run has
    further outputs, whose failures count for this one, too."""
    if not o.failed:
        return ""
    which = "samples in which no output failed" if several else "samples that have a value"
    return (f"This result is conditional on the {which}: {thousands(o.valid)} of {thousands(total(o))} "
            f"({of_all(o.valid / total(o))}).")


def explanation(r):
    """Why failed samples of one output change the others, for the notes of a run; "" if there is nothing to explain."""
    failed = max((o.failed for o in r.outputs), default=0)
    if not failed or len(r.outputs) < 2:
        return ""
    return ("A sample in which any output fails is left out of every output. An output that never fails itself is then "
            "described by a part of its distribution only. Run the outputs in scenarios of their own to obtain each in full.")


def reason(o):
    """Why a budget and samples differ where samples failed; "" if none or few did."""
    return (f"{percent(o.failed / total(o))} of the samples failed and are left out: samples and indices describe only the "
            "others, whereas the budget describes all") if o.failed >= NOTABLE * total(o) and o.failed else ""
