"""The page holds everything, escapes what users wrote, needs nothing from outside; faults are named."""
import os
import re
import tempfile
import unittest
from html.parser import HTMLParser

import object_folder
from object_modelling.report import page
from object_modelling.report.object_data import Keyframe, ObjectData, ReportError

SECTIONS = ["figures", "turntable", "model", "camera-path", "residuals", "sigma", "coverage", "times", "parameters",
            "versions"]


class Tags(HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.tags = []
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))


class PageTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = os.path.join(folder.name, "an object;$(touch evil)")

    def page(self, **arguments):
        object_folder.make(self.folder, **arguments)
        with open(page.write(self.folder), encoding="utf-8") as text:
            return text.read()

    def test_all_sections_and_no_address(self):
        text = self.page()
        tags = Tags(text).tags
        self.assertEqual([attributes["id"] for tag, attributes in tags if tag == "section"], SECTIONS)
        self.assertEqual(sum(tag == "svg" for tag, _ in tags), 5)
        for tag, attributes in tags:
            self.assertNotIn(tag, ("a", "iframe", "object", "embed"))
            for key in ("src", "href", "xlink:href", "data", "action"):
                value = attributes.get(key) or "#"
                self.assertRegex(value, r"^(data:|#)", "%s %s" % (tag, key))
        self.assertIn("default-src 'none'", text)
        self.assertEqual(sorted(os.listdir(self.folder)), ["mesh", "object.yaml", "quality.yaml", "report.html",
                                                           "turntable.png"])

    def test_the_same_every_time(self):
        first = self.page()
        page.write(self.folder)
        with open(os.path.join(self.folder, "report.html"), encoding="utf-8") as text:
            self.assertEqual(text.read(), first)

    def test_names_are_escaped(self):
        text = self.page(name=object_folder.HOSTILE_NAME)
        self.assertNotIn("<script>alert(1)", text)
        self.assertNotIn('" onload="alert', text)
        self.assertIn("{{ 7 * 6 }}", text)
        self.assertEqual(sum(tag == "script" for tag, _ in Tags(text).tags), 3)
        figures = object_folder.quality()
        figures["sessions"][0]["id"] = figures["views"][0]["session_id"] = "</script><b>x"
        figures["parameters"]["</td><img src=x>"] = "<i>"
        text = page.render(ObjectData(object_folder.make(self.folder + "2", figures=figures)))
        for hostile in ("<b>x", "<img src=x>", "<i>"):
            self.assertNotIn(hostile, text)

    def test_a_partial_object_says_what_it_lacks(self):
        self.assertNotIn('id="partial"', self.page())  # an object of before: nothing is known of it
        left_out = [{"id": "side", "reason": "with 'up': <b>too little</b> in common"}]
        text = page.render(ObjectData(object_folder.make(self.folder + "2", partial=True, sessions_left_out=left_out)))
        self.assertIn('id="partial"', text)
        self.assertIn("Made from 2 of 3 sessions", text)
        self.assertIn("<code>side</code>: with &#39;up&#39;: &lt;b&gt;too little", text)
        with self.assertRaisesRegex(ReportError, "object.yaml"):
            ObjectData(object_folder.make(self.folder + "3", sessions_left_out=[{"id": "side"}]))

    def test_traffic_lights(self):
        def light(**arguments):
            return Keyframe("up", 0, object_folder.residual(0, **arguments)).light
        self.assertEqual(light(), "green")
        self.assertEqual(light(after_px=0.51), "amber")
        self.assertEqual(light(after_m=0.0031), "amber")
        self.assertEqual(light(count=19), "amber")
        self.assertEqual(light(after_px=1.01), "red")
        self.assertEqual(light(after_m=0.0061), "red")
        self.assertEqual(Keyframe("up", 0, object_folder.residual(0), left_out=True).light, "red")
        self.assertEqual(Keyframe("up", 0).light, "grey")
        object_folder.make(self.folder)
        data = ObjectData(self.folder)
        self.assertEqual([data.count(colour) for colour in ("green", "amber", "red", "grey")], [9, 1, 2, 1])

    def test_a_model_without_texture_has_no_viewer(self):
        object_folder.make(self.folder)
        os.remove(os.path.join(self.folder, "mesh", "textured.glb"))
        text = page.render(ObjectData(self.folder))
        self.assertIn("No 3-D view", text)
        self.assertNotIn('id="viewer"', text)
        self.assertEqual([tag for tag, _ in Tags(text).tags if tag == "script"], [])

    def test_nothing_refined_and_no_pictures(self):
        figures = object_folder.quality()
        figures["sessions"][0]["refinement"] = None
        object_folder.make(self.folder, figures=figures)
        os.remove(os.path.join(self.folder, "turntable.png"))
        text = page.render(ObjectData(self.folder))
        self.assertIn("Not refined", text)
        self.assertIn("turntable.png is missing", text)

    def test_faults_are_named_and_leave_the_old_page(self):
        before = self.page()
        quality = os.path.join(self.folder, "quality.yaml")
        for broken in ("", "[1", "- 1", "sessions: []\nviews: []\n", "sessions: 5\nviews: []\n"):
            with open(quality, "w") as text:
                text.write(broken)
            with self.assertRaisesRegex(ReportError, "quality.yaml"):
                page.write(self.folder)
        os.remove(quality)
        with self.assertRaisesRegex(ReportError, "quality.yaml"):
            page.write(self.folder)
        with open(os.path.join(self.folder, "report.html"), encoding="utf-8") as text:
            self.assertEqual(text.read(), before)
        with self.assertRaisesRegex(ReportError, "libjs-three"):
            page.library_scripts(["/nowhere"])
        self.assertEqual(page.main([self.folder]), 1)

    def test_no_script_of_the_library_ends_the_page(self):
        self.assertIsNone(re.search("</script", page.library_scripts(), re.IGNORECASE))


if __name__ == "__main__":
    unittest.main()
