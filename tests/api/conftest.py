from collections.abc import Callable

import pytest

from yehu_server import YehuError


@pytest.fixture
def refused() -> Callable[..., None]:
    """Check that a call is refused in one line that has some words in it."""

    def check(words: str, call: Callable[..., object], *given: object, **options: object) -> None:
        with pytest.raises(YehuError) as refused:
            call(*given, **options)
        assert words in str(refused.value), (given, options)
        assert "\n" not in str(refused.value), (given, options)

    return check
