"""Photographs of pages by a headless Chromium."""

import shutil
import subprocess

import pytest

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
WIDTH, HEIGHT = 1000, 700


def photograph(page, folder):
    """Return a screenshot (HEIGHT, WIDTH, 3) in [0, 1] of a page, and the browser's messages."""
    from matplotlib.image import imread

    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        pytest.skip("no Chromium to open the page with (Debian: apt-get install chromium)")
    source, picture = folder / "page.html", folder / "page.png"
    source.write_text(page, encoding="utf-8")
    command = [
        browser,
        "--headless",
        "--no-sandbox",
        "--disable-gpu",
        "--disable-dev-shm-usage",
        "--disable-background-networking",
        "--enable-unsafe-swiftshader",
        "--host-resolver-rules=MAP * ~NOTFOUND",
        "--enable-logging=stderr",
        f"--user-data-dir={folder / 'profile'}",
        f"--window-size={WIDTH},{HEIGHT}",
        "--virtual-time-budget=3000",
        f"--screenshot={picture}",
        source.as_uri(),
    ]
    done = subprocess.run(command, capture_output=True, text=True, timeout=900, check=True)
    messages = [line for line in done.stderr.splitlines() if "CONSOLE" in line]
    return imread(picture)[:, :, :3], [m for m in messages if "GPU stall" not in m]
