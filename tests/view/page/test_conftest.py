"""Without a browser the tests are skipped at a desk and fail where they are relied upon."""

from __future__ import annotations

import pytest

from tests.browsers import absent


@pytest.mark.parametrize(("ci", "outcome"), [("", pytest.skip.Exception), ("true", pytest.fail.Exception)])
def test_an_absent_browser_fails_in_ci(monkeypatch: pytest.MonkeyPatch, ci: str, outcome: type[BaseException]) -> None:
    monkeypatch.setenv("CI", ci)
    with pytest.raises(outcome, match="no chromium"):
        absent("no chromium")
