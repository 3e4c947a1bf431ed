"""Serves a folder with `denavit view` and holds what it promises.

    python tests/pages/view.py DENAVIT

Only this computer is answered, only results are handed out, and the page follows its folder.
"""

import http.client
import os
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from playwright.sync_api import sync_playwright

PAGE = '<!DOCTYPE html><html lang="en"><title>{0}</title><p class="verdict good">{0} is good.</p>'


def ask(port, path, host=None, method="GET"):
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=10)
    connection.putrequest(method, path, skip_host=True, skip_accept_encoding=True)
    connection.putheader("Host", host or f"127.0.0.1:{port}")
    connection.endheaders()
    answer = connection.getresponse()
    return answer.status, answer.read().decode("utf-8", "replace")


def hold(folder, port):
    assert ask(port, "/a.html")[0] == 200
    assert ask(port, "/deep/b%20c.html")[0] == 200
    for path in ["/../secret.html", "/%2e%2e/secret.html", "/..%2fsecret.html", "/secret.key", "/link.html",
                 "/.hidden.html", "//etc/passwd", "/deep/", "/%00", "/%"]:
        status, text = ask(port, path)
        assert status in (400, 404) and "secret" not in text, (path, status)
    assert ask(port, "/", host="evil.example")[0] == 403
    assert ask(port, "/a.html", method="POST")[0] == 403
    addresses = {one[4][0] for one in socket.getaddrinfo(socket.gethostname(), None, socket.AF_INET)}
    for address in addresses - {"127.0.0.1"}:
        with socket.socket() as other:
            other.settimeout(2)
            if address.startswith("127."):
                continue
            assert other.connect_ex((address, port)) != 0, f"{address} is answered"


def follow(folder, port):
    chromium = os.environ.get("CHROMIUM", "/usr/bin/chromium")
    with sync_playwright() as player:
        browser = player.chromium.launch(executable_path=chromium, args=["--no-sandbox"])
        page = browser.new_page()
        faults = []
        page.on("console", lambda note: faults.append(note.text) if note.type == "error" else None)
        page.goto(f"http://127.0.0.1:{port}/")
        page.wait_for_selector("text=a is good.")
        page.wait_for_timeout(2500)
        (folder / "new.html").write_text(PAGE.format("new"))
        page.wait_for_selector("text=new is good.", timeout=10_000)
        page.click("text=a.html")
        page.wait_for_selector("text=a is good.")
        browser.close()
        assert not [one for one in faults if "favicon" not in one and "404" not in one], faults


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name) / "results"
        (folder / "deep").mkdir(parents=True)
        (Path(name) / "secret.html").write_text("secret")
        (folder / "secret.key").write_text("secret")
        (folder / ".hidden.html").write_text("secret")
        (folder / "link.html").symlink_to(Path(name) / "secret.html")
        (folder / "a.html").write_text(PAGE.format("a"))
        (folder / "deep" / "b c.html").write_text(PAGE.format("b"))
        command = [sys.argv[1], "view", str(folder)]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as serving:
            try:
                line = serving.stdout.readline()
                port = int(line.split("127.0.0.1:")[1].split("/")[0])
                hold(folder, port)
                follow(folder, port)
            finally:
                serving.terminate()
    print("view: what it serves, and to whom")


if __name__ == "__main__":
    main()
