#!/usr/bin/python3
"""A peer to measure against: three.js in headless Chromium draws the exported crowd. Prints one line of JSON.

Usage: three_crowd.py SCENE --modules DIR [--order exported] [--poses keys] [--view near] [--characters 1000]

SCENE is the folder that export_character.py wrote, DIR one with node_modules/three. The page is three/crowd.js.
"""
import argparse
import functools
import http.server
import json
import os
import pathlib
import queue
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import urllib.parse

from PIL import Image

PAGE = pathlib.Path(__file__).resolve().parent / "three"
# How Chromium comes to WebGL without a GPU: Mesa's driver, through the X server, or its own.
DRIVERS = {"llvmpipe": ["--use-gl=angle", "--use-angle=gl"],
           "swiftshader": ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]}


class Handler(http.server.BaseHTTPRequestHandler):
    """Serves the page, its module and the scene; takes the result and the first frame's pixels."""
    protocol_version = "HTTP/1.1"
    types = {".html": "text/html", ".js": "text/javascript", ".json": "application/json"}

    def __init__(self, folders, answers, *arguments):
        self.folders, self.answers = folders, answers
        super().__init__(*arguments)

    def do_GET(self):
        path = urllib.parse.urlsplit(self.path).path
        prefix = next((prefix for prefix in self.folders if path.startswith(prefix)), None)
        file = self.folders[prefix] / path[len(prefix):] if prefix else None
        if file is None or ".." in path or not file.is_file():
            self.send_error(404)
            return
        body = file.read_bytes()
        self.send_response(200)
        self.send_header("Content-Type", self.types.get(file.suffix, "application/octet-stream"))
        self.send_header("Content-Length", str(len(body)))
        # Isolated pages have a clock of 5 microseconds, others one of 100.
        self.send_header("Cross-Origin-Opener-Policy", "same-origin")
        self.send_header("Cross-Origin-Embedder-Policy", "require-corp")
        self.end_headers()
        self.wfile.write(body)

    def do_POST(self):
        self.answers.put((self.path, self.rfile.read(int(self.headers["Content-Length"]))))
        self.send_response(200)
        self.send_header("Content-Length", "0")
        self.end_headers()

    def log_message(self, *_):
        pass


def start_browser(chosen, url, profile, log):
    command = [chosen.chromium, "--headless=new", f"--user-data-dir={profile}", "--no-first-run", "--disable-extensions",
               "--disable-background-networking", "--disable-component-update", "--ignore-gpu-blocklist",
               "--disable-gpu-watchdog", *DRIVERS[chosen.driver], url]
    if os.geteuid() == 0:
        command.insert(1, "--no-sandbox")  # Chromium refuses to run as root with it
    with log.open("w") as said:
        return subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=said)


def stop_browser(browser):
    browser.terminate()
    try:
        browser.wait(10)
    except subprocess.TimeoutExpired:
        browser.kill()
        browser.wait()


def wait_for_result(answers, browser, timeout, log):
    """The first frame's pixels, and what the page says."""
    pixels = b""
    for _ in range(int(timeout)):
        try:
            path, body = answers.get(timeout=1)
        except queue.Empty:
            if browser.poll() is not None:
                said = (log.read_text().strip() or "it said nothing").splitlines()[-1]
                sys.exit(f"three_crowd.py: the browser ended with {browser.returncode}: {said}")
            continue
        if path == "/picture":
            pixels = body
        else:
            return pixels, json.loads(body)
    sys.exit(f"three_crowd.py: no result after {timeout:.0f} s")


def draw(chosen):
    folders = {"/scene/": chosen.scene, "/node_modules/": chosen.modules / "node_modules", "/": PAGE}
    answers = queue.Queue()
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Handler, folders, answers))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    options = {name: getattr(chosen, name) for name in ("order", "poses", "view", "characters", "warm", "frames")}
    url = f"http://127.0.0.1:{server.server_port}/index.html?{urllib.parse.urlencode(options)}"
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        log = pathlib.Path(folder, "log")
        browser = start_browser(chosen, url, f"{folder}/profile", log)
        try:
            pixels, result = wait_for_result(answers, browser, chosen.timeout, log)
        finally:
            stop_browser(browser)
    if "error" in result:
        sys.exit(f"three_crowd.py: {result['error']}")
    if chosen.picture:
        scene = json.loads((chosen.scene / "scene.json").read_text())
        picture = Image.frombytes("RGBA", (scene["width"], scene["height"]), pixels)
        picture.transpose(Image.Transpose.FLIP_TOP_BOTTOM).save(chosen.picture)
    return result


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene", type=pathlib.Path)
    parser.add_argument("--modules", type=pathlib.Path, required=True, help="folder with node_modules/three")
    parser.add_argument("--order", default="exported", choices=["exported", "optimised"])
    parser.add_argument("--poses", default="keys", choices=["keys", "interpolated"])
    parser.add_argument("--view", default="near")
    parser.add_argument("--characters", type=int, default=1000)
    parser.add_argument("--warm", type=int, default=2, help="frames before the first that counts")
    parser.add_argument("--frames", type=int, default=5, help="frames that count")
    parser.add_argument("--picture", help="PNG of the first frame")
    parser.add_argument("--driver", default="llvmpipe", choices=list(DRIVERS))
    parser.add_argument("--chromium", default=shutil.which("chromium") or "chromium")
    parser.add_argument("--timeout", type=float, default=900, help="seconds")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("three_crowd.py: ended"))  # the browser ends with it
    print(json.dumps(draw(parser.parse_args())))


if __name__ == "__main__":
    main()
