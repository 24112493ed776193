#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
"""Makes FOLDER/operator.conf of a nats-server that wants credentials, and two files of credentials:
FOLDER/good.creds of a user of its account, and FOLDER/bad.creds of an account that the server does not know.
Keys are made by openssl; JWTs are as nsc writes them."""
import base64
import hashlib
import json
import subprocess
import sys
import time

PREFIXES = {"operator": 14 << 3, "account": 0, "user": 20 << 3}
SEED = 18 << 3


def crc16(data):
    crc = 0
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = (crc << 1 ^ 0x1021 if crc & 0x8000 else crc << 1) & 0xFFFF
    return crc


def encode(data):
    return base64.b32encode(data + crc16(data).to_bytes(2, "little")).decode().rstrip("=")


def base64url(data):
    return base64.urlsafe_b64encode(data).decode().rstrip("=")


class Key:
    def __init__(self, kind, path):
        self.kind, self.path, prefix = kind, path, PREFIXES[kind]
        subprocess.run(["openssl", "genpkey", "-algorithm", "ed25519", "-out", path], check=True)
        raw = lambda *more: subprocess.run(["openssl", "pkey", "-in", path, "-outform", "DER", *more], check=True,
                                           capture_output=True).stdout[-32:]
        self.public = encode(bytes([prefix]) + raw("-pubout"))
        self.seed = encode(bytes([SEED | prefix >> 5, (prefix & 31) << 3]) + raw())

    def sign(self, data):
        message = self.path + ".message"
        with open(message, "wb") as out:
            out.write(data)
        return subprocess.run(["openssl", "pkeyutl", "-sign", "-rawin", "-inkey", self.path, "-in", message], check=True,
                              capture_output=True).stdout


def jwt(issuer, subject, **nats):
    claims = {"iat": int(time.time()), "iss": issuer.public, "sub": subject.public, "name": subject.kind,
              "nats": {"type": subject.kind, "version": 2, **nats}}
    claims["jti"] = base64.b32encode(hashlib.sha256(json.dumps(claims).encode()).digest()).decode().rstrip("=")
    body = ".".join(base64url(json.dumps(part).encode()) for part in ({"typ": "JWT", "alg": "ed25519-nkey"}, claims))
    return body + "." + base64url(issuer.sign(body.encode()))


def credentials(path, account, user):
    token = jwt(account, user, pub={}, sub={}, subs=-1, data=-1, payload=-1)
    with open(path, "w") as out:
        out.write(f"-----BEGIN NATS USER JWT-----\n{token}\n------END NATS USER JWT------\n\n"
                  f"-----BEGIN USER NKEY SEED-----\n{user.seed}\n------END USER NKEY SEED------\n")


def main(folder):
    operator, account, stranger = (Key(kind, f"{folder}/{name}.key") for kind, name in
                                   (("operator", "operator"), ("account", "account"), ("account", "stranger")))
    limits = {name: -1 for name in ("subs", "data", "payload", "imports", "exports", "conn", "leaf")}
    with open(f"{folder}/operator.conf", "w") as out:
        out.write(f"operator: {jwt(operator, operator)}\nresolver: MEMORY\nresolver_preload: {{\n"
                  f"  {account.public}: {jwt(operator, account, limits={**limits, 'wildcards': True})}\n}}\n")
    credentials(f"{folder}/good.creds", account, Key("user", f"{folder}/user.key"))
    credentials(f"{folder}/bad.creds", stranger, Key("user", f"{folder}/other.key"))


main(sys.argv[1])
