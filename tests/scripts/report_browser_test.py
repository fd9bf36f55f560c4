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
# What reaches beyond the window, leaving out what scrolls in a box of its own.
TOO_WIDE = """[...document.querySelectorAll("body *")]
  .filter(element => !element.closest(".wide *, .frame *"))
  .filter(element => element.getBoundingClientRect().right > document.documentElement.clientWidth + 0.5)
  .map(element => `${element.tagName} ${element.className}`)"""
# Boxes that hide a part of what is in them.
SCROLLING = """[...document.querySelectorAll(".wide, .frame")]
  .filter(box => box.scrollWidth > box.clientWidth).map(box => box.className)"""
# [width of a picture on the page, of its file]
PICTURE = """[document.querySelector("#figure3 img").getBoundingClientRect().width,
              document.querySelector("#figure3 img").naturalWidth]"""
SMALLEST_PICTURE_PX = 600  # where letters of 8 points in a figure of 7.4 inches are 9 pixels high
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

    def open_page(self, width):
        browser = self.enterContext(Browser(width, 900))
        browser.open(self.page)
        browser.wait_for(LOADED)
        return browser

    def test_nothing_is_clipped_on_a_wide_window(self):
        browser = self.open_page(1280)
        self.assertEqual(browser.value(TOO_WIDE), [])
        self.assertEqual(browser.value(SCROLLING), [])

    def test_on_a_phone_wide_things_scroll_in_their_own_box_and_letters_stay_legible(self):
        browser = self.open_page(420)
        self.assertEqual(browser.value(TOO_WIDE), [])
        self.assertLessEqual({"wide", "frame"}, set(browser.value(SCROLLING)))
        self.assertGreaterEqual(browser.value(PICTURE)[0], SMALLEST_PICTURE_PX)
        viewport = browser.value("document.querySelector('meta[name=viewport]').content")
        self.assertIn("width=device-width", viewport)
        self.assertNotRegex(viewport, "user-scalable|maximum-scale")

    def test_a_click_shows_a_picture_in_full_size_and_another_puts_it_back(self):
        browser = self.open_page(420)
        before, full = browser.value(PICTURE)
        self.assertLess(before, full)
        for width in (full, before):
            x, y, *_ = browser.place("#figure3 .frame")
            browser.click(x + 200, y + 50)
            self.assertEqual(browser.value(PICTURE)[0], width)

    def test_the_checks_of_width_find_what_they_are_there_to_find(self):
        page = self.page.with_name("wide.html")
        head = ("<!DOCTYPE html><html><head><link rel='icon' href='data:,'>"
                "<style>.wide { overflow: auto } p { width: 900px }</style></head>")
        for box, too_wide, scrolling in (("plain", ["P "], []), ("wide", [], ["wide"])):
            page.write_text(f"{head}<div class={box}><p>long</p></div></html>")
            with self.subTest(box), Browser(600, 400) as browser:
                browser.open(page)
                browser.wait_for(LOADED)
                self.assertEqual(browser.value(TOO_WIDE), too_wide)
                self.assertEqual(browser.value(SCROLLING), scrolling)

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
