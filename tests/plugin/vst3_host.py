"""A VST3 host in Python, of the controller: calls functions of interfaces by their places."""

import ctypes

RESULT, POINTER = ctypes.c_int32, ctypes.c_void_p
NO_INTERFACE = -1
UNKNOWN = (0x00000000, 0x00000000, 0xC0000000, 0x00000046)
CONTROLLER = (0xDCD7BBE3, 0x7742448D, 0xA874AACC, 0x979C759E)
KEY_SWITCHES = (0x1F2F76D3, 0xBFFB4B96, 0xB99527A5, 0x5EBCCEF4)
UNITS = (0x3D4BD6B5, 0x913A4FD2, 0xA886E768, 0xA5EB92C1)
UNIT_HANDLER = (0x4B5147F8, 0x4654486B, 0x8DAB30BA, 0x163A3C56)


def identity(words):
    return b"".join(word.to_bytes(4, "big") for word in words)


class KeySwitch(ctypes.Structure):
    _fields_ = (
        ("type", ctypes.c_uint32),
        ("title", ctypes.c_uint16 * 128),
        ("short_title", ctypes.c_uint16 * 128),
        *((name, ctypes.c_int32) for name in ("lowest", "highest", "remapped", "unit", "flags")),
    )


def text(units):
    return "".join(map(chr, units)).partition("\0")[0]


class Interface:
    """An interface of an object: a pointer to a pointer to a table of functions."""

    def __init__(self, pointer):
        self.pointer = pointer

    def call(self, place, *values, returns=RESULT):
        """Call a function; values are of ctypes."""
        table = POINTER.from_address(self.pointer).value
        address = POINTER.from_address(table + place * ctypes.sizeof(POINTER)).value
        kinds = [POINTER, *map(type, values)]
        return ctypes.CFUNCTYPE(returns, *kinds)(address)(self.pointer, *values)

    def query(self, words):
        """Another interface of the same object, or None."""
        found = POINTER()
        place = ctypes.cast(ctypes.pointer(found), POINTER)
        wanted = ctypes.create_string_buffer(identity(words), 16)
        self.call(0, ctypes.cast(wanted, POINTER), place)
        return Interface(found.value) if found.value else None


class Host:
    """What the controller reports to: kinds and values in `heard`."""

    def __init__(self):
        self.heard = []
        query = ctypes.CFUNCTYPE(RESULT, POINTER, POINTER, ctypes.POINTER(POINTER))
        count = ctypes.CFUNCTYPE(ctypes.c_uint32, POINTER)
        one = ctypes.CFUNCTYPE(RESULT, POINTER, ctypes.c_int32)
        two = ctypes.CFUNCTYPE(RESULT, POINTER, ctypes.c_int32, ctypes.c_int32)
        edit = ctypes.CFUNCTYPE(RESULT, POINTER, ctypes.c_uint32, ctypes.c_double)
        unknown = [query(self._query), count(lambda _: 1), count(lambda _: 1)]
        mark = one(lambda *_: 0)
        self._functions = (
            [*unknown, mark, edit(lambda *_: 0), mark, one(self._restart)],
            [*unknown, mark, two(self._change)],
        )
        self._tables = [
            (POINTER * len(each))(*(ctypes.cast(function, POINTER) for function in each))
            for each in self._functions
        ]
        self._objects = [POINTER(ctypes.addressof(table)) for table in self._tables]
        self.handler = POINTER(ctypes.addressof(self._objects[0]))

    def _query(self, _, wanted, into):
        is_units = ctypes.string_at(wanted, 16) == identity(UNIT_HANDLER)
        into[0] = ctypes.addressof(self._objects[1]) if is_units else None
        return 0 if is_units else NO_INTERFACE

    def _restart(self, _, flags):
        self.heard.append(("restart", flags))
        return 0

    def _change(self, _, programs, program):
        self.heard.append(("names", programs, program))
        return 0


class Controller:
    """The plug-in's controller, connected to a host."""

    def __init__(self, library):
        entry = ctypes.CDLL(str(library)).GetPluginFactory
        entry.restype = POINTER
        factory = Interface(entry())
        about = ctypes.create_string_buffer(1024)
        factory.call(5, ctypes.c_int32(0), ctypes.cast(about, POINTER))
        made = POINTER()
        wanted = ctypes.create_string_buffer(identity(CONTROLLER), 16)
        place = ctypes.cast(ctypes.pointer(made), POINTER)
        factory.call(6, ctypes.cast(about, POINTER), ctypes.cast(wanted, POINTER), place)
        self.object = Interface(made.value)
        self.host = Host()
        self.object.call(16, self.host.handler)

    def set(self, number, unit):
        self.object.call(15, ctypes.c_uint32(number), ctypes.c_double(unit))

    def get(self, number):
        return self.object.call(14, ctypes.c_uint32(number), returns=ctypes.c_double)

    def text(self, number, unit):
        written = (ctypes.c_uint16 * 128)()
        place = ctypes.cast(written, POINTER)
        self.object.call(10, ctypes.c_uint32(number), ctypes.c_double(unit), place)
        return text(written)

    def key_switches(self, channel=0):
        """The names and keys of switches, as the host reads them."""
        switches = self.object.query(KEY_SWITCHES)
        where = ctypes.c_int32(0), ctypes.c_int16(channel)
        found = []
        for index in range(switches.call(3, *where)):
            info = KeySwitch()
            assert (
                switches.call(4, *where, ctypes.c_int32(index), POINTER(ctypes.addressof(info)))
                == 0
            )
            assert info.lowest == info.highest
            found.append((text(info.title), info.lowest))
        beyond = POINTER(ctypes.addressof(KeySwitch()))
        assert switches.call(4, *where, ctypes.c_int32(len(found)), beyond) != 0
        return found

    def key_names(self):
        """The names of keys by the first program, by key."""
        units, program = self.object.query(UNITS), (ctypes.c_int32(1), ctypes.c_int32(0))
        found = {}
        for key in range(128):
            name = (ctypes.c_uint16 * 128)()
            if units.call(10, *program, ctypes.c_int16(key), ctypes.cast(name, POINTER)) == 0:
                found[key] = text(name)
        assert (units.call(9, *program) == 0) == bool(found)
        return found
