"""The page of a trace claims nothing that its result does not hold: no correction, correlation or mark that is not there.

usage: trace_truth_report_test.py path/to/gumshoe [unittest options]
"""
import math
import sys
import types
import unittest

from made_traces import Made
from program import ROOT

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "reports"))
from choose_report_test import words_of
from gumshoe_report import compensation, csv_tables, page, read, trace


class Claims(Made):
    def words(self, r):
        return words_of(page.render(r)).replace("&#8239;", " ").replace("\u202f", " ")

    def test_where_nothing_was_found_no_budget_changes(self):
        r = read.result(self.file("named"))
        self.assertIn("an unknown error has become a correction", self.words(r))
        r.trace.findings = []
        self.assertNotRegex(self.words(r), "with what was found|an unknown error has become")

    def test_scatter_is_no_correction(self):
        r = read.result(self.file("named"))
        r.trace.findings = read.result(self.file("scatter")).trace.findings
        words = self.words(r)
        self.assertIn("The scatter that was found is now part of the uncertainty.", words)
        self.assertNotIn("an unknown error has become", words)

    def test_a_correlation_that_is_not_stored_is_not_stated(self):
        r = read.result(self.file("class"))
        self.assertRegex(self.words(r), r"correlation with the best 1\.00")
        for c in r.trace.candidates:
            c.correlation = 0.0
        self.assertNotRegex(self.words(r), "(?i)correlation (with the best|of 1 cannot)")
        self.assertEqual({c["correlation"] for c in csv_tables.trace(r.trace)["candidates"]}, {""})

    def test_errors_have_their_name_and_each_row_is_of_one_reading(self):
        r = read.result(self.file("named"))
        t = r.trace
        words = self.words(r)
        self.assertNotRegex(words, "(?i)root mean square of the residuals \\(")
        self.assertIn("residual standard deviation (µm)", words)
        held_out = [row for row in t.residuals if row.final]
        held_out[3].before, held_out[3].after = -5e-5, 2e-7
        held_out[5].before, held_out[5].after = 3e-6, -4e-5
        t.rms.worst_point_before, t.rms.worst_point_after = 5e-5, 4e-5
        t.rms.worst_point = f"reading {held_out[5].reading + 1}"
        words = self.words(r)
        self.assertRegex(words, rf"largest residual of one reading before ?reading {held_out[3].reading + 1} \([^)]*\) ?50\.\d* ?0\.20")
        self.assertRegex(words, rf"largest residual of one reading after ?reading {held_out[5].reading + 1} \([^)]*\) ?3\.00 ?40\.")

    def test_captions_name_what_is_drawn(self):
        r = read.result(self.file("named"))
        words = self.words(r)
        self.assertIn("Black: means with two standard errors.", words)
        self.assertIn("Block offsets, such as one per set-up, are subtracted", words)
        r.trace.blocks = ""
        for k, v in r.trace.data.conditions.items():
            v.values = [float(n) for n in range(len(v.values))]
        r.trace.residuals = [row for row in r.trace.residuals if row.reading < 8]
        r.trace.data.columns = {}
        words = self.words(r)
        self.assertNotIn("Black: means", words)
        self.assertNotIn("Block offsets, such", words)

    def test_the_command_that_writes_all_rows_is_named(self):
        r = read.result(self.file("named"))
        r.trace.limits = r.trace.limits * 10
        self.assertIn(f"of {len(r.trace.limits)}; gumshoe report named.h5 writes all to a CSV table", self.words(r))
        self.assertNotIn("the CSV table has all", self.words(r))

    def test_an_estimate_without_U_is_rounded_and_says_so(self):
        r = read.result(self.file("named"))
        for b in (*r.trace.before, *r.trace.after):
            b.expanded_uncertainty = b.combined_standard_uncertainty = math.nan
            b.estimate = -2.71e-19
            b.rows[-1].contribution, b.rows[-1].sensitivity = 1e-25, 1e-20
        words = self.words(r)
        self.assertRegex(words, r"estimate ?0\.0+ mm, no U ?0\.0+ mm, no U")
        self.assertNotIn("e−2", words[words.index("before and after"):])

    def test_a_reference_has_no_uncertainty(self):
        row = lambda y, u: types.SimpleNamespace(y=y, u=u, readings=30)
        t = types.SimpleNamespace(size_display_factor=1e6, size_display_units="um", indication="y", rows=[row(0.0, 0.0), row(3.071e-6, 6.8e-8)],
                                  keys={"operator": types.SimpleNamespace(values=["A", "B"])})
        first, second = compensation.table(t).rows
        self.assertEqual((first.error, first.u, second.error, second.u), ("reference", "", "3.071", "0.068"))

    def test_equal_limits_are_in_one_unit(self):
        limit = lambda unit, factor, value: types.SimpleNamespace(display_units=unit, display_factor=factor, display_offset=0, value=value)
        self.assertEqual([trace.of_limit(limit(*at))[0] for at in (("um", 1e6, 5.4e-4), ("mm", 1e3, 5.4e-4), ("um", 1e6, 5e-6), ("mm", 1e3, 5e-6))],
                         ["mm", "mm", "um", "um"])

    def test_only_what_needs_attention_is_marked(self):
        warns = {kind: trace.Trace(read.result(self.file(kind)).trace).warns() for kind in
                 ("named", "nothing_found", "insufficient_data", "vetoed")}
        self.assertEqual(warns, {"named": False, "nothing_found": False, "insufficient_data": True, "vetoed": True})


if __name__ == "__main__":
    unittest.main()
