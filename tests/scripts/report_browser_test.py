"""The report in headless Chromium: no error, nothing broken, something to see, also on a narrow screen."""
import pathlib
import tempfile
import unittest

from browser import Browser, blank_reason
from report_data import write_tree
from synthetic import run_script

# [links of the contents that lead nowhere, pictures that could not be decoded, pictures, pixels too wide]
STATE = """[
  [...document.querySelectorAll("nav a")].filter(link => !document.querySelector(link.hash)).length,
  [...document.images].filter(image => !image.complete || image.naturalWidth < 100).length,
  document.images.length,
  document.documentElement.scrollWidth - window.innerWidth
]"""
LOADED = "document.readyState === 'complete'"


class ReportInBrowserTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory()
        cls.addClassCleanup(scratch.cleanup)
        write_tree(scratch.name)
        result = run_script("report", scratch.name)
        if result.returncode != 0:
            raise AssertionError(result.stderr)
        # Alone in a directory, so that it can lean on no other file.
        cls.page = pathlib.Path(scratch.name) / "alone" / "report.html"
        cls.page.parent.mkdir()
        (pathlib.Path(scratch.name) / "report.html").rename(cls.page)

    def test_nothing_is_wrong_and_there_is_something_to_see_on_wide_and_narrow_screens(self):
        for width, height in ((1400, 900), (420, 1200)):
            with self.subTest(width=width), Browser(width, height) as browser:
                browser.open(self.page)
                browser.wait_for(LOADED)
                dead, broken, pictures, too_wide = browser.value(STATE)
                self.assertEqual((dead, broken), (0, 0))
                self.assertGreaterEqual(pictures, 10)
                self.assertLessEqual(too_wide, 0, "the page scrolls sideways")
                for place in ("figure3", "table1", "verdicts", "ladder"):
                    browser.value(f"{place}.scrollIntoView({{behavior: 'instant'}})")  # by its id
                    self.assertIsNone(blank_reason(browser.picture()), place)
                self.assertEqual(browser.problems, [])

    def test_the_checks_fail_on_what_they_are_there_to_find(self):
        page = self.page.with_name("test.html")
        for body, words in (("<script>console.error('bad', 3)</script>",
                             "bad 3"), ("<script>no_such_function()</script>", "no_such_function"),
                            ("<img src='not_there.png'>", "Failed to load"), ("", None)):
            page.write_text(f"<!DOCTYPE html><html><head><link rel='icon' href='data:,'></head>{body}</html>")
            with self.subTest(body), Browser(600, 400) as browser:
                browser.open(page)
                browser.wait_for(LOADED)
                self.assertIsNotNone(blank_reason(browser.picture()))
                self.assertEqual(browser.value(STATE)[1], 1 if "img" in body else 0)
                if words:
                    browser.wait_for("true")
                    self.assertIn(words, " ".join(browser.problems))
                else:
                    self.assertEqual(browser.problems, [])


if __name__ == "__main__":
    unittest.main()
