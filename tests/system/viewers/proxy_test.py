#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""foxglovesink behind nginx and Caddy, by the configurations that docs/viewing.md prints.

Each serves the page and its sockets below a path, over TLS, to clients with a token; an idle connection lives on.
"""
import http.client
import pathlib
import re
import shutil
import ssl
import subprocess
import sys
import tempfile
import time

from edge import Edge
from ports import free_port
from viewer import Viewer

ROOT = pathlib.Path(__file__).resolve().parents[3]
TOKEN = "a-token-of-this-test"
SKIPPED = 77
# nginx closes a connection that is silent for longer than IDLE_LIMIT [s]. The server sends a ping
# every 10 s, so a connection must remain open for IDLE [s].
IDLE_LIMIT, IDLE = 13, 20


def printed(language):
    """The configuration of the page in that language."""
    return re.search(f"```{language}\n(.*?)```", (ROOT / "docs/viewing.md").read_text(), re.DOTALL)[1]


def nginx(folder, port, server):
    location = printed("nginx").replace("8765", str(server)).replace("timeout 60s", f"timeout {IDLE_LIMIT}s")
    (folder / "nginx.conf").write_text(
        f"""daemon off; pid {folder}/pid; error_log {folder}/errors; events {{}}
http {{
  access_log off; client_body_temp_path {folder}/body; proxy_temp_path {folder}/proxy;
  fastcgi_temp_path {folder}/fastcgi; uwsgi_temp_path {folder}/uwsgi; scgi_temp_path {folder}/scgi;
  server {{ listen 127.0.0.1:{port} ssl; ssl_certificate {folder}/cert.pem; ssl_certificate_key {folder}/key.pem;
{location} }}
}}"""
    )
    return ["nginx", "-c", str(folder / "nginx.conf"), "-e", str(folder / "errors")]


def caddy(folder, port, server):
    own = f"https://edge.example:{port} {{\nbind 127.0.0.1\ntls cert.pem key.pem"
    site = printed("caddy").replace("8765", str(server)).replace("edge.example {", own)
    (folder / "Caddyfile").write_text("{\nadmin off\nauto_https off\ndefault_sni edge.example\n}\n" + site)
    return ["caddy", "run", "--config", "Caddyfile", "--adapter", "caddyfile"]


def get(port, path):
    context = ssl.create_default_context()
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    connection = http.client.HTTPSConnection("127.0.0.1", port, context=context, timeout=10)
    connection.request("GET", path, headers={"Host": "edge.example"})
    answer = connection.getresponse()
    return answer.status, answer.read()


def wait_for(port):
    until = time.monotonic() + 20
    while time.monotonic() < until:
        try:
            return get(port, "/robots/session")
        except OSError:
            time.sleep(0.2)
    raise TimeoutError("the proxy does not listen")


def try_proxy(make, folder, edge):
    port = free_port()
    process = subprocess.Popen(make(folder, port, edge.port), cwd=folder, stderr=subprocess.DEVNULL, env={
        "HOME": str(folder), "PATH": "/usr/sbin:/usr/bin:/sbin:/bin"})
    try:
        assert wait_for(port)[0] == 401, "a token is needed"
        status, page = get(port, "/robots/")
        assert status == 200 and b"<title>" in page, "the page"
        for name in re.findall(rb'(?:src|href)="([^"/:]+|\./[^":]+)"', page):
            assert get(port, "/robots/" + name.decode().removeprefix("./"))[0] == 200, name
        assert get(port, f"/robots/session?token={TOKEN}")[0] == 200, "the token"
        viewer = Viewer(port, path=f"/robots/?token={TOKEN}", host="edge.example", tls=True)
        viewer.run(3)
        assert viewer.slices, "slices"
        idle = Viewer(port, topic="/none", path=f"/robots/?token={TOKEN}", host="edge.example", tls=True)
        idle.run(IDLE)  # raises an error if the connection is closed
    finally:
        process.terminate()
        process.wait()


def main():
    missing = [name for name in ("nginx", "caddy", "openssl") if not shutil.which(name, path="/usr/sbin:/usr/bin")]
    if missing:
        print("not installed:", *missing)
        return SKIPPED
    with tempfile.TemporaryDirectory() as name, Edge(sink=f"token={TOKEN}") as edge:
        folder = pathlib.Path(name)
        subprocess.run(
            "openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:prime256v1 -nodes -keyout key.pem -out cert.pem "
            "-subj /CN=edge.example -addext subjectAltName=DNS:edge.example,IP:127.0.0.1 -days 2".split(),
            cwd=folder, check=True, stderr=subprocess.DEVNULL)
        for make in (nginx, caddy):
            try_proxy(make, folder, edge)
            print(make.__name__, "serves")
    return 0


if __name__ == "__main__":
    sys.exit(main())
