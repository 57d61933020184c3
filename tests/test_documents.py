"""The one reader of TOML and JSON: errors have line, place and a near word."""

import pytest

from yehu_server.errors import MappingError, ParameterError
from yehu_server.util.documents import Document, Fields
from yehu_server.util.parsing import MAX_KEY_PARTS, ParsingError, parse_toml
from yehu_server.util.values import brief, choice, flag, number, whole

TEXT = """
gain = 3
[room]
siz = 9
decay = "long"
[[bind]]
channel = 1
[[bind]]
channel = 17
soft = 1
"""


def read(table: Fields) -> list[object]:
    room = table.table("room")
    found: list[object] = [
        table.read("gain", number, 0.0, -60.0, 6.0, "dB"),
        room.read("size", number, 8.0),
        room.read("decay", number, 2.0, 0.1, 9.0, "s"),
    ]
    room.refuse_others()
    for bind in table.tables("bind"):
        found += [bind.need("channel", whole, 1, 16), bind.read("soft", flag, False)]
    table.refuse_others()
    table.document.raise_errors()
    return found


def document(text: str, most_errors: int = 1) -> Document:
    return Document("mine.toml", "a file", MappingError, text=text, most_errors=most_errors)


def test_all_errors_are_sorted_by_line_with_place_and_a_near_word():
    with pytest.raises(MappingError) as error:
        read(document(TEXT, 50).toml())
    assert [*error.value.lines] == [
        "mine.toml:4: room.siz: unknown entry; did you mean size? (known: size, decay)",
        "mine.toml:5: room.decay: expected a number, got 'long'",
        "mine.toml:9: bind 2: channel: expected a whole number from 1 to 16, got 17",
        "mine.toml:10: bind 2: soft: expected true or false, got 1",
    ]


BEFORE = [
    'a = """\n[b]\n\\"# = """', "a = '''\n'\n''' # ]", 'a = "\\"#[["', "a = '\"['",
    "a = [ # ]\n [1,\n2]]", "'a.b' = 1 # = [", '["a.\\"#="]', "[[x]]\n[x.y]\n[[x]]", "a = 1\r",
]  # fmt: skip


def test_lines_are_counted_whatever_strings_brackets_and_comments_come_before(subtests):
    for before in BEFORE:
        with subtests.test(before), pytest.raises(MappingError) as error:
            read(document(f"{before}\n[room]\nsiz = 9\n", 50).toml())
        wrong = f"mine.toml:{before.count(chr(10)) + 3}: room.siz: unknown"
        assert any(wrong in line for line in error.value.lines), before


def test_else_the_first_is_raised_at_once():
    with pytest.raises(MappingError, match=r"^mine\.toml:5: room\.decay: expected a number"):
        read(document(TEXT).toml())


def test_what_is_right_is_read_and_what_is_missing_has_its_default():
    assert read(document("gain = 3\nbind = [{channel = 2}]").toml()) == [3.0, 8.0, 2.0, 2, False]
    assert read(document('{"gain": 3, "bind": []}').json()) == [3.0, 8.0, 2.0]


def test_data_without_a_file_have_their_place_alone(subtests):
    for data, reason in [
        ([], "expected a table of names and values, got []"),
        ({"gain": 9}, "gain: 9 is not within -60 to 6 dB"),
        ({"gain": float("nan")}, "gain: nan is not finite"),
        ({"gain": 10**5000}, "gain: a very large number is not finite"),
        ({"room": 3}, "room: expected a table"),
        ({"room": {"a\nb": 3}}, r"room: 'a\\nb': unknown entry"),
        ({"bind": 3}, "bind: write each as [[bind]]"),
        ({"bind": [3]}, "bind 1: expected a table"),
        ({"bind": [{}]}, "bind 1: channel: missing"),
        ({"x" * 10**6: 3}, f"{'x' * 77}...: unknown entry"),
    ]:
        with subtests.test(data=data, reason=reason):
            with pytest.raises(ParameterError) as error:
                read(Fields(data))
            assert str(error.value).startswith(reason.replace("\\\\", "\\"))
            assert len(str(error.value)) < 200


def test_an_error_keeps_the_place_that_it_has_and_gets_one_where_it_has_none():
    table = Document("mine.toml", text="[bow]\nlaw = 'thermic'").toml()
    match = r"^mine\.toml:2: bow\.law: .*did you mean thermal\?$"
    with pytest.raises(ParameterError, match=match), table.at():
        table.table("bow").read("law", choice, "", ("thermal", "plastic"))
    with pytest.raises(ParameterError, match=r"^mine\.toml:1: bow: too heavy$"), table.at("bow"):
        raise ParameterError("too heavy")


def test_what_is_no_toml_or_json_has_its_line():
    for text, read_as in (
        *((text, Document.toml) for text in ("a = 1\na = 2\n", "\nb = ]", "\nb\n")),
        ('{"a":\n3', Document.json),
    ):
        with pytest.raises(MappingError, match=r"^mine\.toml:2: not a file \("):
            read_as(document(text))


def test_what_is_no_toml_is_told_in_plain_words():
    for wrong, told in (
        ("/room/level = 1", "expected NAME = VALUE or [TABLE]; names with / are quoted"),
        ("rate = fast", "expected a value; text is quoted"),
        ("rate: 3", "expected = after the name"),
        ("rate = 1,5", "expected the end of the line after the value"),
        ("[set", "expected ] after the name of a table"),
        ("a = 1", "this name is there already"),
        ("b = [1 2]", "expected , or ]"),
        ("b = {c = 1", "expected , or }"),
        (r'b = "c:\users"', r"a backslash in text is written \\"),
        (r'b = "\ud800"', r"a backslash in text is written \\"),
        ("b = 2026-02-30", "expected a value; text is quoted"),
        ("b = {c = 1, c = 2}", "this name is there already"),
        ('b = "\x01"', "expected no control character"),
        ('b = "tune', "text without its closing quotation mark"),
    ):
        with pytest.raises(MappingError) as error:
            document(f"a = 1\n{wrong}\n").toml()
        assert str(error.value) == f"mine.toml:2: not a file ({told}, got {brief(wrong)})"


# ---------------------------------------------------------------- time that TOML takes


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("a.b.c = 1", {"a": {"b": {"c": 1}}}),
        ("\"/a.b\".'c.d' = 1", {"/a.b": {"c.d": 1}}),
        (f'a = "{". " * 100}" # {"." * 100}', {"a": ". " * 100}),
        ("a = 1.5\nb = 1979-05-27T07:32:00.5", None),
    ],
)
def test_what_is_as_usual_is_read(text, value):
    found = parse_toml(text)
    assert value is None or found == value


@pytest.mark.parametrize("part", [".a", ' . "a b"', ".'a'", "\t.\ta-1"])
@pytest.mark.parametrize("around", ["{} = 1", "[{}]", "[[{}]]", "x = {{ {} = 1 }}"])
def test_a_key_of_very_many_parts_is_refused_before_it_takes_time(part, around):
    parse_toml(around.format("a" + part * (MAX_KEY_PARTS - 1)))
    with pytest.raises(ValueError, match="parts"):
        parse_toml(around.format("a" + part * 20_000))


@pytest.mark.parametrize("text", ["a" * 60_000, '"' * 60_000, "'a" * 30_000, "a.b " * 15_000])
def test_searching_for_such_keys_takes_no_time_itself(text):
    with pytest.raises(ParsingError, match=", got "):
        parse_toml(text)
