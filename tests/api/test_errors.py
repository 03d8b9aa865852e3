"""Bad input on every route: 4xx in the one error shape, never a 500, never NaN in a body."""

from copy import deepcopy
from typing import Any

import pytest
from fastapi.testclient import TestClient

from looplab.api.answers.base import Error

LOOP: dict[str, Any] = {
    "loop": {"plant": {"type": "expr", "text": "1/(s+1)^3"}, "controller": {"type": "pid", "Kc": 3.6}}
}
TUNE: dict[str, Any] = {"plant": {"type": "expr", "text": "1/(s+1)^3"}}
CHECK = "/labs/ziegler-nichols-third-order/check"
ROUTES = [
    *("/loop", "/tune", "/frequency", "/margins", "/nyquist", "/root-locus", "/laplace", "/approximate", "/routh"),
    *("/stability", "/response", "/state-space", CHECK, "/labs/validate"),
    *("/plants/cstr/simulate", "/models/simulate", "/models/validate", "/plants/cstr/control", "/models/control"),
    *("/tune/optimal", "/tune/trade-off", "/compare", "/gain-map", "/controller-forms"),
    *("/mimo/rga", "/mimo/simulate", "/mimo/interaction", "/mimo/decoupler", "/mimo/tune"),
    *("/state-feedback", "/state-feedback/simulate", "/state-feedback/region"),
    *("/pole-placement", "/smith"),
    *("/limits", "/bode-integral", "/spectrum"),
]
RAW = {
    "empty": b"",
    "open": b"{",
    "NaN": b'{"loop": NaN}',
    "Infinity": b'{"loop": -Infinity}',
    "1e999": b'{"loop": 1e999}',
    "surrogate": b'{"loop": "\\ud800"}',
    "not utf-8": b'{"loop": "\xff"}',
    "deep": b"[" * 100_000,
    "string": b'"x"',
    "null": b"null",
    "list": b"[]",
    "number": b"3",
    "unknown field": b'{"nonsense": 1}',
    "1 MB": b'{"a": "' + b"x" * 1_000_000 + b'"}',
}


def check(response: Any, path: str | None = None) -> None:
    assert 400 <= response.status_code < 500, response.text
    assert response.headers["content-type"] == "application/json"
    error = Error.model_validate_json(response.content).error
    assert error.message
    assert error.code
    assert b": NaN" not in response.content
    assert b":NaN" not in response.content
    assert b"Traceback" not in response.content
    if path is not None:
        assert error.path == path, error


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.parametrize("name", RAW)
def test_hostile_bodies(post: Any, route: str, name: str) -> None:
    response = post(route, RAW[name])
    if route.endswith("/validate") and name == "unknown field":
        # A draft of a lab or a model is judged, not refused.
        assert response.status_code == 200
        assert response.json()["valid"] is False
        return
    check(response)


def test_a_body_without_length_is_bounded_too(client: TestClient) -> None:
    def chunks() -> Any:
        for _ in range(40):
            yield b" " * 10_000

    check(client.post("/api/v1/loop", content=chunks(), headers={"Content-Type": "application/json"}))


def changed(path: str, value: Any, base: dict[str, Any] = LOOP) -> dict[str, Any]:
    body = deepcopy(base)
    at = body
    *parents, last = path.split(".")
    for name in parents:
        at = at[name]
    at[last] = value
    return body


@pytest.mark.parametrize(
    ("where", "value", "path"),
    [
        ("loop", 1, "loop"),
        ("loop.plant", {"type": "foo"}, "loop.plant"),
        ("loop.plant", {"text": "1/s"}, "loop.plant"),
        ("loop.plant", {"type": "expr", "text": "1/(s2+1)"}, "loop.plant.text"),
        ("loop.plant", {"type": "expr", "text": "s^2+1"}, "loop.plant"),
        ("loop.plant", {"type": "expr", "text": ""}, "loop.plant.text"),
        ("loop.plant", {"type": "expr", "text": "(" * 450}, "loop.plant.text"),
        ("loop.plant", {"type": "zpk", "poles": [-1] * 51}, "loop.plant.poles"),
        ("loop.plant", {"type": "zpk", "poles": [[0, 1]]}, "loop.plant.poles"),
        ("loop.plant", {"type": "tf", "num": [1], "den": [0, 0]}, "loop.plant.den"),
        ("loop.plant", {"type": "tf", "num": [], "den": [1]}, "loop.plant.num"),
        ("loop.plant", {"type": "tf", "num": [1, "a"], "den": [1, 1]}, "loop.plant.num[1]"),
        ("loop.plant", {"type": "tf", "num": [1, 0, 0], "den": [1, 1]}, "loop.plant"),
        ("loop.plant", {"type": "fopdt", "K": 1, "tau": 0}, "loop.plant.tau"),
        ("loop.plant", {"type": "fopdt", "K": 0, "tau": 1}, "loop.plant.K"),
        ("loop.plant", {"type": "fopdt", "K": 1, "tau": 1, "theta": -1}, "loop.plant.theta"),
        ("loop.plant", {"type": "fopdt", "K": 1, "tau": 1, "theta": "1"}, "loop.plant.theta"),
        ("loop.plant", {"type": "fopdt", "K": True, "tau": 1}, "loop.plant.K"),
        ("loop.controller", {"type": "pidd"}, "loop.controller"),
        ("loop.controller", {"type": "pid", "Kc": 1, "tau_I": 0}, "loop.controller.tau_I"),
        ("loop.controller", {"type": "pid", "Kc": 1, "tau_D": 1, "alpha": 0}, "loop.controller.alpha"),
        ("loop.controller", {"type": "pid", "form": "parallel", "Kc": 1}, "loop.controller.Kp"),
        ("loop.controller", {"type": "pid", "form": "parallel", "Kp": 1, "Ki": -1}, "loop.controller.Ki"),
        ("loop.controller", {"type": "expr", "text": "1+s"}, "loop.controller"),
        ("horizon", -1, "horizon"),
        ("horizon", 1e-320, "horizon"),
        ("points", 3, "points"),
        ("points", 10**9, "points"),
        ("points", 100.5, "points"),
        ("omega", [10, 1], "omega"),
        ("omega", [1], "omega"),
        ("want", ["foo"], "want[0]"),
        ("arrays", "f2", "arrays"),
        ("nonsense", 1, "nonsense"),
    ],
)
def test_a_bad_loop_names_its_field(post: Any, where: str, value: Any, path: str | None) -> None:
    response = post("/loop", changed(where, value))
    check(response, path)


def test_an_ill_posed_loop(post: Any) -> None:
    body = changed("loop.plant", {"type": "expr", "text": "(s+2)/(s+1)"})
    body["loop"]["controller"] = {"type": "pid", "Kc": -1}
    check(post("/loop", body), "loop.controller")


def test_a_dead_time_too_short_for_the_horizon(post: Any) -> None:
    body = changed("loop.plant", {"type": "fopdt", "K": 1, "tau": 1, "theta": 1e-9})
    check(post("/loop", {**body, "horizon": 10}), "loop.plant")


@pytest.mark.parametrize(
    ("body", "path"),
    [
        ({}, ""),
        ({**TUNE, "ultimate": {"Ku": 1, "Pu": 1}}, ""),
        ({"ultimate": {"Ku": 1, "Pu": 0}}, "ultimate.Pu"),
        ({"ultimate": {"Ku": 0, "Pu": 1}, "rules": ["ziegler_nichols"]}, "ultimate.Ku"),
        ({"model": {"K": 0, "tau": 1, "theta": 1}}, "model.K"),
        ({"plant": {"type": "expr", "text": "s"}}, "plant"),
        ({**TUNE, "rules": []}, "rules"),
        ({**TUNE, "rules": ["magic"]}, "rules[0]"),
        ({**TUNE, "types": ["PIDD"]}, "types[0]"),
    ],
)
def test_a_bad_tune_request(post: Any, body: dict[str, Any], path: str | None) -> None:
    check(post("/tune", body), path)


@pytest.mark.parametrize("path", ["/api/v1/nowhere", "/api/v1/labs/nowhere", "/api/v1/labs/..%2f..", "/nowhere"])
def test_nothing_there(client: TestClient, path: str) -> None:
    response = client.get(path)
    assert response.status_code == 404
    check(response)


def test_a_wrong_method_says_what_is_allowed(client: TestClient) -> None:
    response = client.get("/api/v1/loop")
    assert response.status_code == 405
    assert response.headers["allow"] == "POST"
    check(response)


def test_every_answer_carries_the_policy(client: TestClient) -> None:
    for path in ("/", "/workbench", "/api/v1/health", "/nowhere"):
        assert "script-src 'self'" in client.get(path).headers["content-security-policy"]
