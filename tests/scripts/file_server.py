# SPDX-License-Identifier: GPL-3.0-or-later
"""A file server for tests of downloads, which can resume them."""

import functools
import http.server
import pathlib
import threading


class Handler(http.server.SimpleHTTPRequestHandler):
    """Serves files, or the rest of a file from byte N if `Range: bytes=N-` requests that."""

    def log_message(self, format, *args):  # noqa: A002
        pass

    def do_GET(self):
        self.server.requests.append((self.path, self.headers.get("Range")))
        path = pathlib.Path(self.translate_path(self.path))
        if not self.server.resumes or "Range" not in self.headers or not path.is_file():
            super().do_GET()
            return
        data = path.read_bytes()
        start = int(self.headers["Range"].removeprefix("bytes=").rstrip("-"))
        self.send_response(206 if start < len(data) else 416)
        self.send_header("Content-Range", f"bytes {start}-{len(data) - 1}/{len(data)}")
        self.send_header("Content-Length", str(max(0, len(data) - start)))
        self.end_headers()
        self.wfile.write(data[start:])


def start(test, folder):
    """Serves a folder until the end of the test. Returns the server; `requests` are those it got,
    and `resumes` tells whether it sends the rest of a file."""
    handler = functools.partial(Handler, directory=folder)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
    server.requests = []
    server.resumes = True
    test.addCleanup(server.server_close)
    test.addCleanup(server.shutdown)
    threading.Thread(target=server.serve_forever, args=(0.01,), daemon=True).start()
    return server
