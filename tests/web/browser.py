# SPDX-License-Identifier: Apache-2.0
"""Headless Chromium as a person uses it: opens a page, looks, presses, waits for what is to be seen."""
import base64
import os
import tempfile

from selenium import webdriver
from selenium.common.exceptions import JavascriptException, StaleElementReferenceException
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys

from processes import NEVER, until

SIZES = {"phone": (360, 780), "desk": (1280, 800), "wall": (2560, 1440)}
THEMES = ("light", "dark")


class Browser:
    def __init__(self):
        self.profile = tempfile.TemporaryDirectory(prefix="axisgate-browser-")
        options = webdriver.ChromeOptions()
        for argument in ("--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars", "--force-color-profile=srgb",
                         f"--user-data-dir={self.profile.name}", "--disable-background-networking", "--no-first-run",
                         *(["--no-sandbox"] if os.geteuid() == 0 else [])):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(options=options, service=Service("/usr/bin/chromedriver"))
        self.driver.set_script_timeout(NEVER)
        self.driver.set_page_load_timeout(NEVER)
        self.size("desk")

    def close(self):
        self.driver.quit()
        self.profile.cleanup()

    def size(self, name):
        width, height = SIZES[name]
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False})

    def theme(self, name):
        self.run("window.axisgateTheme.choose(arguments[0])", name)

    def go(self, address):
        self.driver.get(address)

    def run(self, script, *arguments):
        return self.driver.execute_script(script, *arguments)

    def run_later(self, script, *arguments):
        """A script that calls `done` with its result, or with a text that begins with "failed"."""
        result = self.driver.execute_async_script(f"const done = arguments[arguments.length - 1]; (async () => {{ {script} }})().catch(e => done(`failed: ${{e.stack}}`));", *arguments)
        assert not str(result).startswith("failed"), result
        return result

    def texts(self, selector):
        """Of all that are shown; as they stand in the page, all at one moment."""
        return self.run("return [...document.querySelectorAll(arguments[0])].filter(e => e.checkVisibility()).map(e => e.textContent)", selector)

    def text(self, selector):
        return " ".join(self.texts(selector))

    def attributes(self, selector, name):
        return self.run("return [...document.querySelectorAll(arguments[0])].map(e => e.getAttribute(arguments[1]))", selector, name)

    def element(self, selector):
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def press(self, selector):
        self.element(selector).click()

    def type(self, selector, text):
        field = self.element(selector)
        field.clear()
        field.send_keys(text)

    def key(self, *keys):
        self.driver.switch_to.active_element.send_keys(*keys)

    def focused(self):
        return self.driver.switch_to.active_element

    def until(self, what, look):
        """The first true value; a page that changes under a look is looked at again."""
        def again():
            try:
                return look()
            except (StaleElementReferenceException, JavascriptException):
                return None

        try:
            return until(what, again)
        except AssertionError as failed:
            raise AssertionError(f"{failed}; the page reads: {self.text('body')[:3000]}") from None

    def until_text(self, selector, part):
        return self.until(f"'{part}' in {selector}", lambda: part in self.text(selector))

    def complaints(self):
        """What its console says since the last look; a connection that is refused while the gateway is away is no mistake of the page."""
        return [f"{entry['level']}: {entry['message']}" for entry in self.driver.get_log("browser") if entry["level"] in ("SEVERE", "WARNING")]

    def picture(self, path):
        with open(path, "wb") as file:
            file.write(base64.b64decode(self.driver.execute_cdp_cmd("Page.captureScreenshot", {"format": "png"})["data"]))


__all__ = ["Browser", "Keys", "SIZES", "THEMES"]
