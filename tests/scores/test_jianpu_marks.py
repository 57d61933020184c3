"""Marks of jianpu: each on its note, at its beat."""

from yehu_server.params.articulations import ARTICULATIONS
from yehu_server.scores.jianpu.mark_words import AHEAD, COMMANDS, FINGERING, TEXTS
from yehu_server.scores.jianpu.reader import parse_jianpu
from yehu_server.scores.written.notated import MARKS, SIGNS, SPANS, Mark, Part, Sign, Span
from yehu_server.scores.written.words import meaning_of


def part(text: str) -> Part:
    score = parse_jianpu(text.encode())
    assert not score.unknown
    assert not score.warnings
    return score.parts[0]


def signs(text: str) -> list[tuple[float, str]]:
    return [(float(sign.beat), sign.name) for sign in part(text).signs]


def test_every_word_means_something_that_a_score_can_say():
    for action in (*COMMANDS.values(), *FINGERING.values(), *AHEAD.values(), *TEXTS.values()):
        if action.kind == "mark":
            assert action.name in MARKS
        elif action.kind == "sign":
            assert action.name in SIGNS
        elif action.kind == "hairpin":
            assert action.name in SPANS
        else:
            assert (action.kind, action.name) in {
                ("hairpin end", ""), ("glissando", ""), ("contour", "")
            }  # fmt: skip


def test_a_mark_belongs_to_the_note_before_it(subtests):
    for word, mark in [
        ("\\upbow", Mark("up-bow")),
        ("^\\downbow", Mark("down-bow")),
        ("\\staccato", Mark("staccato")),
        ("-.", Mark("staccato")),
        ("->", Mark("accent")),
        ("-^", Mark("marcato")),
        ("\\fermata", Mark("fermata")),
        ("\\trill", Mark("trill", 2.0)),
        ("\\mordent", Mark("mordent", 2.0)),
        ("\\prall", Mark("inverted-mordent", 2.0)),
        ("\\turn", Mark("turn", 2.0, 2.0)),
        ("Fr=0", Mark("finger", 0)),
        ("Fr=3", Mark("finger", 3)),
        ("Fr=内", Mark("inner-string")),
        ("\\2", Mark("outer-string")),
        ("harmonic", Mark("harmonic")),
        ("up", Mark("slide-in-up")),
        ("Fr=down", Mark("slide-in-down")),
        ("tilde", Mark("vibrato")),
    ]:
        with subtests.test(word=word, mark=mark):
            first, second, third = part(f"1 2 {word} 3").notes
            assert second.marks == (mark,)
            assert not first.marks
            assert not third.marks
            assert part(f"2 - {word}").notes[0].marks == (mark,)


def test_slides_and_glissandi_are_written_before_their_note():
    first, second, third = part("slideUp 1 2 slideDown 3").notes
    assert [note.marks for note in (first, second, third)] == [
        (Mark("slide-in-up"),),
        (),
        (Mark("slide-in-down"),),
    ]
    assert part("1 glis 2 - 5").spans == (Span("glissando", 1, 3),)
    assert part("1 2 \\glissando 5").spans == (Span("glissando", 1, 2),)


def test_a_returning_slide_leaves_its_note_and_comes_back():
    (note,) = part("3 - bend").notes
    shares, steps = zip(*note.contour, strict=True)
    assert shares == tuple(sorted(shares))
    assert (steps[0], min(steps), steps[-1]) == (0.0, -2.0, 0.0)


def test_tremolo_is_three_strokes_or_two_notes_in_turns_under_one_bow():
    assert part("1/// -").notes[0].marks == (Mark("tremolo", 3.0),)
    played = part("1///5 - 2")
    assert [note.pitch for note in played.notes[:4]] == [60.0, 67.0, 60.0, 67.0]
    assert len(played.notes) == 17
    assert played.spans == (Span("slur", 0, played.notes[15].beat),)


def test_grace_notes_stand_before_and_after_with_lengths_of_their_own():
    for text, before, after in [
        ("g[#4d5] 1 ['1s2]g", [(66, 0.25), (67, 0.125)], [(72, 0.25), (62, 0.25)]),
        ("g[d45] 1", [(65, 0.125), (67, 0.25)], []),
        ("g[1&3&5d2] 1", [(67, 0.25), (62, 0.125)], []),  # the highest that sound together
    ]:
        (note,) = part(text).notes
        for graces, expected in ((note.before, before), (note.after, after)):
            assert [(grace.pitch, float(grace.length)) for grace in graces] == expected, text


def test_dynamics_and_texts_hold_from_the_note_before_them():
    for text, found in [
        ("1 \\p 2 3 - \\f 4 \\sfz", [(0, "p"), (3, "f"), (4, "sfz")]),
        ('1 ^"pizz." 2 _"arco" 3', [(0, "pizz"), (1, "arco")]),
        ('1 ^"拨弦" 2 ^"拉弦" 3 ^"外"', [(0, "pizz"), (1, "arco"), (2, "outer-string")]),
        ('1 ^"sul pont." 2', [(0, "sul-ponticello")]),
    ]:
        assert signs(text) == found


def test_a_hairpin_ends_at_its_end_or_at_the_next_dynamic():
    assert part("1 \\< 2 3 \\! 4").spans == (Span("crescendo", 0, 2),)
    assert part("1 2 \\> 3 - - \\p").spans == (Span("diminuendo", 1, 4),)
    assert part("1 \\< 2 \\> 3 - \\!").spans == (Span("crescendo", 0, 1), Span("diminuendo", 1, 3))


def test_articulations_are_named_in_two_languages():
    assert part('1 ^"上滑音" 2').notes[0].marks == (Mark("slide-in-up"),)
    wrong = []
    for number, row in enumerate(ARTICULATIONS):
        name = "gesture" if row.fingers else "articulation"
        for word in (row.name, row.chinese):
            (found,) = part(f'1 2 ^"{word}" 3').signs or (None,)
            usual = meaning_of(word)  # what the word meant before: pizz., trem., vib.
            if found != Sign(1, name, number) and usual.kind == name:
                wrong.append((word, found))
    assert wrong == []


def test_a_ritardando_ends_at_the_next_tempo():
    score = parse_jianpu('4=90 1 1 ^"渐慢" 1 1 4=60 1'.encode())
    assert score.parts[0].spans == (Span("ritardando", 1, 4),)
    score = parse_jianpu('4=90 1 1 ^"rit." 1 1 ^"原速" 1'.encode())
    assert score.parts[0].spans == (Span("ritardando", 1, 3),)
    assert [(tempo.beat, tempo.quarters_per_minute) for tempo in score.tempi] == [(0, 90), (3, 90)]
    (span,) = parse_jianpu(b'1 ^"rit." ' + b"1 " * 40).parts[0].spans
    assert span.end - span.begin == 8  # without an end, two bars


def test_notes_may_be_joined_to_one_word(subtests):
    for text, notes, slurs in (
        ("1~1", [2], []),
        ("1 ~1 2", [2, 1], []),
        ("(1~1)2", [2, 1], []),
        ("1(2 3)4", [1, 1, 1, 1], [(0, 2)]),
        ("(1 2~2)", [1, 2], [(0, 1)]),
    ):
        with subtests.test(text):
            played = part(text)
            assert [each.length for each in played.notes] == notes
            assert [(each.begin, each.end) for each in played.spans] == slurs
    assert parse_jianpu(b"1 (() )) 2").unknown == {"(()": 1, "))": 1}


def test_a_slur_at_the_beginning_of_a_repeat_is_of_its_first_note_in_each_pass():
    for text in ("1=F 3 R{ ( 1 2 ) 3 4 }", "1=F 3 |: 4=80 ( 1 2 ) 3 4 :|"):
        assert [(each.begin, each.end) for each in part(text).spans] == [(1, 2), (5, 6)]
    ending = part("R{ 1 } A{ ( 2 3 ) | ( 4 5 ) }")
    assert [(each.begin, each.end) for each in ending.spans] == [(1, 2), (4, 5)]
    over_the_bar = parse_jianpu(b"4/4 1 2 3 4 | ( 3 2 ) 1 1 | 1 2 3 4 ( | 5 )")
    assert [(each.begin, each.end) for each in over_the_bar.parts[0].spans] == [(3, 5), (11, 12)]
    (line,) = over_the_bar.warnings
    assert line.startswith("slurs from the note before a bar line")


def test_slurs_may_lie_within_each_other_and_those_without_an_end_are_warned_of():
    spans = part("1( 2( 3) 4)").spans
    assert {(span.begin, span.end) for span in spans} == {(0, 3), (1, 2)}
    assert parse_jianpu(b"1 ( 2").warnings == ("slurs without an end left out",)
    assert parse_jianpu(b"1 2 )").warnings == ("ends of slurs that did not begin left out",)


def test_words_of_the_page_are_silent():
    text = 'OnePage NoBarNums NoIndent WithStaff 1 letterA \\bar "|." [( 2 )] \\( 3 \\)'
    assert len(part(text).notes) == 3
