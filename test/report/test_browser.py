"""The page in headless Chromium: loads its model, prints nothing on the console, makes no request."""
import json
import os
import re
import shutil
import subprocess
import tempfile
import unittest

import cv2
import numpy as np

import object_folder
from object_modelling.report import page


def chromium():
    for name in ("chromium", "chromium-browser", "google-chrome"):
        if shutil.which(name):
            return shutil.which(name)
    # Ubuntu 20.04 has it as a snap only, which does not run in a container.
    raise unittest.SkipTest("Chromium is not installed (package chromium)")


# Debian 11 has it last: without SwiftShader, and it keeps the console to itself when it is headless.
OLD_CHROMIUM = 120


def major_version():
    answer = subprocess.run([chromium(), "--version"], stdout=subprocess.PIPE, universal_newlines=True, timeout=60,
                            check=True)
    return int(re.search(r"\d+", answer.stdout).group(0))


class BrowserTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = folder.name
        cls.is_old = major_version() <= OLD_CHROMIUM
        made = object_folder.make(os.path.join(folder.name, "box"), name=object_folder.HOSTILE_NAME)
        cls.url = "file://" + page.write(made)
        cls.picture = os.path.join(folder.name, "page.png")
        cls.shown = cls.run_browser(cls.url, "--dump-dom", "--log-net-log=" + cls.path("net.json"))
        cls.run_browser(cls.url, "--screenshot=" + cls.picture, "--window-size=1120,1500")

    @classmethod
    def path(cls, name):
        return os.path.join(cls.folder, name)

    @classmethod
    def run_browser(cls, url, *arguments):
        renderer = (["--use-angle=gl-egl", "--ignore-gpu-blocklist"] if cls.is_old else
                    ["--use-angle=swiftshader", "--enable-unsafe-swiftshader"])
        return subprocess.run(
            [chromium(), "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-gl=angle", *renderer,
             "--disable-dev-shm-usage", "--no-first-run", "--disable-background-networking", "--disable-component-update",
             "--disable-sync",
             "--user-data-dir=" + cls.path("profile"), "--host-resolver-rules=MAP * ~NOTFOUND", "--enable-logging=stderr", "--v=0",
             "--hide-scrollbars", "--virtual-time-budget=20000", *arguments, url],
            stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True, timeout=200, check=True)

    def test_the_viewer_has_loaded_the_model(self):
        viewer = re.search(r'<div id="viewer"[^>]*>', self.shown.stdout).group(0)
        self.assertIn('data-state="loaded"', viewer)
        self.assertIn('data-triangles="432"', viewer)

    def skip_without_console(self):
        if self.is_old:
            self.skipTest("Chromium %d and older do not print the console when they are headless" % OLD_CHROMIUM)

    def test_nothing_on_the_console(self):
        self.skip_without_console()
        messages = [line for line in self.shown.stderr.splitlines() if "CONSOLE" in line]
        self.assertEqual(messages, [])

    def asked_for(self, net_log):
        """Addresses that a page asked the network for; the browser's own questions have no origin."""
        with open(net_log) as text:
            log = json.load(text)
        asked = [event.get("params", {}) for event in log["events"] if "initiator" in event.get("params", {})]
        return {params["url"] for params in asked if "url" in params and params["initiator"] != "not an origin" and
                not re.match(r"(data|blob|file|chrome[a-z-]*|about|devtools):", params["url"])}

    def test_no_request_leaves_the_page(self):
        self.assertEqual(self.asked_for(self.path("net.json")), set())

    def test_requests_and_messages_would_be_noticed(self):
        with open(self.path("asking.html"), "w") as text:
            text.write('<img src="http://elsewhere.example/picture.png"><script>console.error("noticed")</script>')
        shown = self.run_browser("file://" + self.path("asking.html"), "--dump-dom",
                                 "--log-net-log=" + self.path("asking.json"))
        self.assertEqual(self.asked_for(self.path("asking.json")), {"http://elsewhere.example/picture.png"})
        self.skip_without_console()
        self.assertTrue(any("CONSOLE" in line and "noticed" in line for line in shown.stderr.splitlines()))

    def test_the_name_is_text(self):
        title = re.search(r"<h1>(.*?)</h1>", self.shown.stdout, re.DOTALL).group(1)
        self.assertTrue(title.startswith("&lt;script&gt;alert(1)&lt;/script&gt;"), title)

    def test_the_picture_shows_the_box(self):
        """The coloured sides of the box are somewhere on the page, and take a good part of the viewer."""
        picture = cv2.imread(self.picture).astype(int)
        spread = picture.max(2) - picture.min(2)
        self.assertGreater(np.count_nonzero(spread > 90), 20000)


if __name__ == "__main__":
    unittest.main()
