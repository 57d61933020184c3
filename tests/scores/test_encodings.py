"""Names in any encoding: each script is found, and Latin accents stay what they are."""

import mido
import pytest

from yehu_server.errors import ScoreError
from yehu_server.scores.abc.reader import read_abc
from yehu_server.scores.encodings import decoded, encoding_of
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.midi_export import midi_file
from yehu_server.scores.musicxml.reader import parse
from yehu_server.scores.reading import ReadOptions, read_any
from yehu_server.scores.written.performed import performed

SIMPLIFIED = [
    "旋律", "伴奏", "二胡", "琵琶", "唢呐", "古筝", "笛子", "扬琴", "椰胡", "箫", "主旋律",
    "茉莉花", "第一声部", "二泉映月《二胡》", "Erhu二胡",
]  # fmt: skip
TRADITIONAL = [
    "旋律", "伴奏", "二胡", "琵琶", "嗩吶", "古箏", "笛子", "揚琴", "椰胡", "主旋律", "茉莉花",
    "第一聲部",
]  # fmt: skip
JAPANESE = ["メロディ", "伴奏", "ピアノ", "尺八", "三味線", "さくらさくら", "ギター1"]
KOREAN = [
    "멜로디", "반주", "바이올린", "가야금", "해금", "대금", "아리랑", "도라지", "고향의봄",
    "제1바이올린", "봉선화", "뱃노래", "꽃", "남성합창",
]  # fmt: skip
RUSSIAN = [
    "мелодия", "Скрипка", "флейта", "Бас", "Соло", "МЕЛОДИЯ", "Калинка", "Очи чёрные", "Танец",
    "«Катюша»", "Первый голос", "Полонез",
]  # fmt: skip
LATIN = [
    "Flöte", "Größe", "Café", "naïve", "Violín", "Señor", "Für Elise", "Été", "São João", "CANÇÃO",
    "Ænima", "N° 2", "½ speed", "Ångström", "«Ça ira»", "NOËL", "Où", "Übung", "Är", "vy är",
    "Bjørn Ærø", "CRÈME BRÛLÉE", "és", "Þá birtast", "señorita año", "Ça", "© 1997",
]  # fmt: skip


def test_each_encoding_is_found_by_the_characters_of_every_day():
    wrong = []
    for names, codec in (
        (SIMPLIFIED, "gbk"), (SIMPLIFIED, "gb18030"), (TRADITIONAL, "big5"), (JAPANESE, "cp932"),
        (KOREAN, "cp949"), (RUSSIAN, "cp1251"),
    ):  # fmt: skip
        coded = [name.encode(codec) for name in names]
        found = [decoded(each, encoding_of(each)) for each in coded]  # each by itself
        wrong += [(codec, *pair) for pair in zip(names, found, strict=True) if len({*pair}) > 1]
    for names in (SIMPLIFIED, TRADITIONAL, JAPANESE, KOREAN, RUSSIAN):  # all names of a file
        for codec in ("utf-8", "utf-8-sig", "utf-16"):
            coded = [name.encode(codec) for name in names]
            found = [decoded(each, encoding_of(*coded)) for each in coded]
            wrong += [(codec, *pair) for pair in zip(names, found, strict=True) if len({*pair}) > 1]
    assert not wrong


def test_latin_names_do_not_become_chinese():
    wrong = []
    for codec in ("latin-1", "cp1252", "utf-8"):
        coded = [name.encode(codec) for name in [*LATIN, "Piano", ""]]
        found = {texts: encoding_of(*texts) for texts in (*((each,) for each in coded), (*coded,))}
        wrong += [pair for pair in found.items() if pair[1] not in ("latin-1", "utf-8")]
    assert not wrong
    late = "X:1 " * 3000
    assert encoding_of(f"{late}Flöte".encode("latin-1")) == "latin-1"
    assert encoding_of(f"{late} 二胡".encode("gbk")) == "gb18030"
    assert decoded("Flöte".encode("latin-1"), "latin-1") == "Flöte"
    assert encoding_of("Don\u2019t".encode("cp1252")) == "latin-1"  # which is no kanji


@pytest.mark.parametrize(
    ("codec", "told"),
    [
        ("gbk", "GB 18030"), ("utf-16", ""), ("utf-8", ""), ("big5", "Big5"),
        ("cp949", "EUC-KR"), ("cp1251", "Windows-1251"), ("cp932", "Shift-JIS"),
    ],
)  # fmt: skip
def test_the_tune_of_a_midi_file_is_found_by_its_name(codec, told, tmp_path):
    file = mido.MidiFile(type=1)
    names = {"cp949": ("반주", "멜로디"), "cp932": ("ベース", "メロディ")}
    names |= {"cp1251": ("Аккомпанемент", "Мелодия")}
    other, tune = names.get(codec, ("高胡伴奏", "旋律"))
    for name, key in ((other, 79), (tune, 72)):
        file.tracks.append(mido.MidiTrack([
            mido.MetaMessage("track_name", name=name.encode(codec).decode("latin-1")),
            mido.Message("note_on", note=key), mido.Message("note_off", note=key, time=960),
        ]))  # fmt: skip
    file.save(tmp_path / "song.mid")
    for options in (ReadOptions(), ReadOptions(parts=[tune])):
        score = read_any(tmp_path / "song.mid", options)
        assert [part.name for part in score.parts] == [tune]
        struck = [event.message for event in score.events if event.message.type == "note_on"]
        assert [message.note for message in struck] == [72]
        assert any(told in line for line in score.remarks) or not told
        assert told or not any("not UTF-8" in line for line in score.remarks)


def test_scores_are_read_in_the_encoding_that_they_have_or_say(tmp_path):
    wrong = []
    for codec in (
        "utf-8", "gbk", "big5", "utf-16", "utf-8-sig", "cp932", "cp949", "cp1251",
    ):  # fmt: skip
        path = tmp_path / "song.abc"
        name = {"cp949": "해금", "cp1251": "Скрипка"}.get(codec, "二胡旋律")
        path.write_bytes(f"X:1\nT:{name}\nK:C\nCD|\n".encode(codec))
        title = parse_jianpu(f"title={name}\n1 2 3 4\n".encode(codec)).title
        written = read_abc(path)
        if (written.title, title) != (name, name) or (
            codec in ("utf-8", "utf-8-sig", "utf-16")
        ) == bool([line for line in written.remarks if "is not UTF-8: read as" in line]):
            wrong.append((codec, written.title, title, written.remarks))
    for said, codec, name in (
        ("GB2312", "gbk", "二胡"), ("GBK", "gbk", "二胡"), ("GB18030", "gb18030", "二胡"),
        ("Big5", "big5", "二胡"), ("Shift_JIS", "cp932", "二胡"), ("UTF-16", "utf-16", "二胡"),
        ("UTF-8", "utf-8", "二胡"), ("utf-16", "utf-8", "二胡"), ("utf8", "utf-8", "二胡"),
        ("EUC-KR", "cp949", "해금"), ("ks_c_5601-1987", "cp949", "해금"),
        ("GB_2312-80", "gbk", "二胡"), ("windows-949", "cp949", "해금"),
        ("windows-1251", "cp1251", "Скрипка"),
        ("KOI8-R", "koi8-r", "Скрипка"), ("x-euc-jp", "euc-jp", "二胡"),
        ("unicode", "utf-16", "二胡"), ("ISO-2022-JP", "iso2022_jp", "二胡"),
        ("ISO-8859-1", "latin-1", "Flöte"),
    ):  # fmt: skip
        text = f'<?xml version="1.0" encoding="{said}"?><name>{name}</name>'
        if parse(text.encode(codec)).text != name:
            wrong.append((said, parse(text.encode(codec)).text))
    assert not wrong
    for said, reason in (("strange", "not read .strange."), ("GBK", "says that it is gbk")):
        with pytest.raises(ScoreError, match=reason):
            parse(f'<?xml version="1.0" encoding="{said}"?><name>Flö,</name>'.encode("latin-1"))


def test_names_are_written_to_midi_in_utf_8(tmp_path):
    (tmp_path / "song.abc").write_text('X:1\nT:二胡\nK:C\nV:1 name="旋律"\nC|\n', encoding="utf-8")
    written = read_abc(tmp_path / "song.abc")
    data, _ = midi_file(written, performed(written))
    assert "旋律".encode() in data
