"""A fiddle unlike the shipped one, the same for all tests: it is calibrated once, and soon."""

# Its first string is slack, and its fingers reach few notes, so that few have to be measured.
SLACK = {"string_1": {"T": 40.0, "reach": 3.0}, "string_2": {"reach": 3.0}}
SLACK_RANGE = "D#4 to D#5"
SLACK_TOML = "".join(
    f"{name}.{quantity} = {value}\n"
    for name, values in SLACK.items()
    for quantity, value in values.items()
)
