{
 "patcher": {
  "title": "yehu",
  "fileversion": 1,
  "appversion": {
   "major": 8,
   "minor": 5,
   "revision": 5,
   "architecture": "x64",
   "modernui": 1
  },
  "classnamespace": "box",
  "rect": [
   60.0,
   80.0,
   1152,
   900.0
  ],
  "bglocked": 0,
  "openinpresentation": 1,
  "default_fontsize": 12.0,
  "default_fontface": 0,
  "default_fontname": "Arial",
  "gridonopen": 1,
  "gridsize": [
   15.0,
   15.0
  ],
  "gridsnaponopen": 1,
  "objectsnaponopen": 1,
  "statusbarvisible": 2,
  "toolbarvisible": 1,
  "lefttoolbarpinned": 0,
  "toptoolbarpinned": 0,
  "righttoolbarpinned": 0,
  "bottomtoolbarpinned": 0,
  "toolbars_unpinned_last_save": 0,
  "tallnewobj": 0,
  "boxanimatetime": 200,
  "enablehscroll": 1,
  "enablevscroll": 1,
  "devicewidth": 0.0,
  "description": "",
  "digest": "",
  "tags": "",
  "style": "",
  "subpatcher_template": "",
  "assistshowspatchername": 0,
  "boxes": [
   {
    "box": {
     "id": "obj-1",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16.0,
      1326,
      168,
      22
     ],
     "outlettype": [],
     "text": "udpsend 127.0.0.1 9000"
    }
   },
   {
    "box": {
     "id": "obj-2",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1356,
      70,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadbang"
    }
   },
   {
    "box": {
     "id": "obj-3",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      110.0,
      1356,
      42,
      22
     ],
     "text": "1",
     "outlettype": [
      ""
     ]
    }
   },
   {
    "box": {
     "id": "obj-4",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      176.0,
      1356,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "metro 25000"
    }
   },
   {
    "box": {
     "id": "obj-5",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      291.0,
      1356,
      175,
      22
     ],
     "text": "/yehu/subscribe 60 7400",
     "outlettype": [
      ""
     ]
    }
   },
   {
    "box": {
     "id": "obj-6",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1386,
      84,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.out"
    }
   },
   {
    "box": {
     "id": "obj-7",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1416,
      98,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-8",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16.0,
      1446,
      49,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "t b b"
    }
   },
   {
    "box": {
     "id": "obj-9",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      89.0,
      1446,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "delay 250"
    }
   },
   {
    "box": {
     "id": "obj-10",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      190.0,
      1446,
      49,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "t b b"
    }
   },
   {
    "box": {
     "id": "obj-11",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1476,
      42,
      22
     ],
     "text": "0",
     "outlettype": [
      ""
     ]
    }
   },
   {
    "box": {
     "id": "obj-12",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      82.0,
      1476,
      70,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "gate 1 1"
    }
   },
   {
    "box": {
     "id": "obj-13",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      176.0,
      1476,
      77,
      22
     ],
     "outlettype": [],
     "text": "s yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-14",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1506,
      42,
      22
     ],
     "text": "1",
     "outlettype": [
      ""
     ]
    }
   },
   {
    "box": {
     "id": "obj-15",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1536,
      119,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "udpreceive 7400"
    }
   },
   {
    "box": {
     "id": "obj-16",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16.0,
      1566,
      84,
      22
     ],
     "outlettype": [],
     "text": "s yehu.out"
    }
   },
   {
    "box": {
     "id": "obj-17",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      20.0,
      58.0,
      552.0,
      22
     ],
     "text": "string: pitch 65 to 89 MIDI across, press 0.3 to 6 N up",
     "presentation": 1,
     "presentation_rect": [
      20.0,
      58.0,
      552.0,
      22
     ]
    }
   },
   {
    "box": {
     "id": "obj-18",
     "maxclass": "pictslider",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      20.0,
      80.0,
      552.0,
      146.8
     ],
     "outlettype": [
      "int",
      "int"
     ],
     "presentation": 1,
     "presentation_rect": [
      20.0,
      80.0,
      552.0,
      146.8
     ],
     "varname": "string",
     "leftvalue": 0,
     "rightvalue": 1000,
     "bottomvalue": 0,
     "topvalue": 1000
    }
   },
   {
    "box": {
     "id": "obj-19",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1596,
      42,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "t f"
    }
   },
   {
    "box": {
     "id": "obj-20",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      82.0,
      1596,
      147,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/pitch"
    }
   },
   {
    "box": {
     "id": "obj-21",
     "maxclass": "newobj",
     "numinlets": 6,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1626,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "scale 0. 1000. 65.0 89.0"
    }
   },
   {
    "box": {
     "id": "obj-22",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1656,
      42,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "t f"
    }
   },
   {
    "box": {
     "id": "obj-23",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      82.0,
      1656,
      147,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/press"
    }
   },
   {
    "box": {
     "id": "obj-24",
     "maxclass": "newobj",
     "numinlets": 6,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1686,
      168,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "scale 0. 1000. 0.3 6.0"
    }
   },
   {
    "box": {
     "id": "obj-25",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      580.0,
      58.0,
      552.0,
      22
     ],
     "text": "bow: speed -0.6 to 0.6 m/s across, force 0 to 2 N up",
     "presentation": 1,
     "presentation_rect": [
      580.0,
      58.0,
      552.0,
      22
     ]
    }
   },
   {
    "box": {
     "id": "obj-26",
     "maxclass": "pictslider",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      580.0,
      80.0,
      552.0,
      146.8
     ],
     "outlettype": [
      "int",
      "int"
     ],
     "presentation": 1,
     "presentation_rect": [
      580.0,
      80.0,
      552.0,
      146.8
     ],
     "varname": "bow",
     "leftvalue": 0,
     "rightvalue": 1000,
     "bottomvalue": 0,
     "topvalue": 1000
    }
   },
   {
    "box": {
     "id": "obj-27",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1716,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "pak 0. 0."
    }
   },
   {
    "box": {
     "id": "obj-28",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      117.0,
      1716,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow"
    }
   },
   {
    "box": {
     "id": "obj-29",
     "maxclass": "newobj",
     "numinlets": 6,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1746,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "scale 0. 1000. -0.6 0.6"
    }
   },
   {
    "box": {
     "id": "obj-30",
     "maxclass": "newobj",
     "numinlets": 6,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1776,
      168,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "scale 0. 1000. 0.0 2.0"
    }
   },
   {
    "box": {
     "id": "obj-31",
     "maxclass": "kslider",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      20.0,
      234.8,
      1112.0,
      75.2
     ],
     "outlettype": [
      "int",
      "int"
     ],
     "presentation": 1,
     "presentation_rect": [
      20.0,
      234.8,
      1112.0,
      75.2
     ],
     "varname": "keys",
     "mode": 2,
     "offset": 60,
     "range": 36
    }
   },
   {
    "box": {
     "id": "obj-32",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1806,
      70,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "pack 0 0"
    }
   },
   {
    "box": {
     "id": "obj-33",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      110.0,
      1806,
      140,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/note"
    }
   },
   {
    "box": {
     "id": "obj-34",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      16,
      16,
      120,
      22
     ],
     "text": "/yehu/bow 0 0",
     "outlettype": [
      ""
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      16,
      120,
      22
     ]
    }
   },
   {
    "box": {
     "id": "obj-35",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      146,
      16,
      120,
      22
     ],
     "text": "/yehu/release",
     "outlettype": [
      ""
     ],
     "presentation": 1,
     "presentation_rect": [
      146,
      16,
      120,
      22
     ]
    }
   },
   {
    "box": {
     "id": "obj-36",
     "maxclass": "message",
     "numinlets": 2,
     "numoutlets": 1,
     "patching_rect": [
      276,
      16,
      120,
      22
     ],
     "text": "/yehu/panic",
     "outlettype": [
      ""
     ],
     "presentation": 1,
     "presentation_rect": [
      276,
      16,
      120,
      22
     ]
    }
   },
   {
    "box": {
     "id": "obj-37",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      330,
      224,
      22
     ],
     "text": "playing",
     "presentation": 1,
     "presentation_rect": [
      16,
      330,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-38",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      352,
      104,
      48
     ],
     "varname": "/playing/dynamics",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/dynamics",
       "parameter_shortname": "dynamics",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-39",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      402,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      16,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-40",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1836,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-41",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      1836,
      210,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/dynamics"
    }
   },
   {
    "box": {
     "id": "obj-42",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      351.0,
      1836,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-43",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1866,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-44",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      1866,
      224,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/dynamics"
    }
   },
   {
    "box": {
     "id": "obj-45",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      400.0,
      1866,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-46",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      352,
      104,
      48
     ],
     "varname": "/playing/intensity",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/intensity",
       "parameter_shortname": "intensity",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-47",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      402,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      128,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-48",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1896,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-49",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      1896,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/intensity"
    }
   },
   {
    "box": {
     "id": "obj-50",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      1896,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-51",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1926,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.75"
    }
   },
   {
    "box": {
     "id": "obj-52",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      1926,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/intensity"
    }
   },
   {
    "box": {
     "id": "obj-53",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      1926,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-54",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      352,
      104,
      48
     ],
     "varname": "/playing/speed",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/speed",
       "parameter_shortname": "speed",
       "parameter_mmin": 0.03,
       "parameter_mmax": 0.6,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m/s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-55",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      402,
      104,
      22
     ],
     "text": "0.03 to 0.6 m/s",
     "presentation": 1,
     "presentation_rect": [
      240,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-56",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1956,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-57",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      1956,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/speed"
    }
   },
   {
    "box": {
     "id": "obj-58",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      1956,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-59",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      1986,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.2"
    }
   },
   {
    "box": {
     "id": "obj-60",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      1986,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/speed"
    }
   },
   {
    "box": {
     "id": "obj-61",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      1986,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-62",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      352,
      104,
      48
     ],
     "varname": "/playing/velocity",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/velocity",
       "parameter_shortname": "velocity",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-63",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      402,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      352,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-64",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2016,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-65",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2016,
      210,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/velocity"
    }
   },
   {
    "box": {
     "id": "obj-66",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      351.0,
      2016,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-67",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2046,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.63"
    }
   },
   {
    "box": {
     "id": "obj-68",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      2046,
      224,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/velocity"
    }
   },
   {
    "box": {
     "id": "obj-69",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      421.0,
      2046,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-70",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      352,
      104,
      48
     ],
     "varname": "/playing/pressure",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/pressure",
       "parameter_shortname": "pressure",
       "parameter_mmin": 0.05,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-71",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      402,
      104,
      22
     ],
     "text": "0.05 to 2",
     "presentation": 1,
     "presentation_rect": [
      464,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-72",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2076,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-73",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2076,
      210,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/pressure"
    }
   },
   {
    "box": {
     "id": "obj-74",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      351.0,
      2076,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-75",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2106,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.4"
    }
   },
   {
    "box": {
     "id": "obj-76",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      2106,
      224,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/pressure"
    }
   },
   {
    "box": {
     "id": "obj-77",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      2106,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-78",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      352,
      104,
      48
     ],
     "varname": "/playing/brilliance",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/brilliance",
       "parameter_shortname": "brilliance",
       "parameter_mmin": 0.0,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-79",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      402,
      104,
      22
     ],
     "text": "0 to 2",
     "presentation": 1,
     "presentation_rect": [
      576,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-80",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2136,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-81",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2136,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/brilliance"
    }
   },
   {
    "box": {
     "id": "obj-82",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      2136,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-83",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2166,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-84",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2166,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/brilliance"
    }
   },
   {
    "box": {
     "id": "obj-85",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      2166,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-86",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      352,
      104,
      48
     ],
     "varname": "/playing/bow_position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/bow_position",
       "parameter_shortname": "bow position",
       "parameter_mmin": 0.05,
       "parameter_mmax": 0.3,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-87",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      402,
      104,
      22
     ],
     "text": "0.05 to 0.3",
     "presentation": 1,
     "presentation_rect": [
      688,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-88",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2196,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-89",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2196,
      238,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/bow_position"
    }
   },
   {
    "box": {
     "id": "obj-90",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      379.0,
      2196,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-91",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2226,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.13"
    }
   },
   {
    "box": {
     "id": "obj-92",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      2226,
      252,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/bow_position"
    }
   },
   {
    "box": {
     "id": "obj-93",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      449.0,
      2226,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-94",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      352,
      104,
      48
     ],
     "varname": "/playing/tremolo",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/tremolo",
       "parameter_shortname": "tremolo",
       "parameter_mmin": 0.0,
       "parameter_mmax": 20.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f 1/s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-95",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      402,
      104,
      22
     ],
     "text": "0 to 20 1/s",
     "presentation": 1,
     "presentation_rect": [
      800,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-96",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2256,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-97",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2256,
      203,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/tremolo"
    }
   },
   {
    "box": {
     "id": "obj-98",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      344.0,
      2256,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-99",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2286,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-100",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2286,
      217,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/tremolo"
    }
   },
   {
    "box": {
     "id": "obj-101",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      2286,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-102",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      912,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      912,
      352,
      104,
      48
     ],
     "varname": "/playing/tremolo_depth",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/tremolo_depth",
       "parameter_shortname": "tremolo depth",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-103",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      912,
      402,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      912,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-104",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2316,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-105",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2316,
      245,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/tremolo_depth"
    }
   },
   {
    "box": {
     "id": "obj-106",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      386.0,
      2316,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-107",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2346,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-108",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2346,
      259,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/tremolo_depth"
    }
   },
   {
    "box": {
     "id": "obj-109",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      435.0,
      2346,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-110",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      1024,
      352,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      1024,
      352,
      104,
      48
     ],
     "varname": "/playing/pizzicato",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/pizzicato",
       "parameter_shortname": "pizzicato",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-111",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      1024,
      402,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      1024,
      402,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-112",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2376,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-113",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2376,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/pizzicato"
    }
   },
   {
    "box": {
     "id": "obj-114",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      2376,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-115",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2406,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-116",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2406,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/pizzicato"
    }
   },
   {
    "box": {
     "id": "obj-117",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      2406,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-118",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      450,
      104,
      48
     ],
     "varname": "/playing/articulation",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/articulation",
       "parameter_shortname": "articulation",
       "parameter_mmin": 0.0,
       "parameter_mmax": 25,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-119",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      500,
      104,
      22
     ],
     "text": "0 to 25",
     "presentation": 1,
     "presentation_rect": [
      16,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-120",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2436,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-121",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2436,
      238,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/articulation"
    }
   },
   {
    "box": {
     "id": "obj-122",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      379.0,
      2436,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-123",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2466,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-124",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2466,
      252,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/articulation"
    }
   },
   {
    "box": {
     "id": "obj-125",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      2466,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-126",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      450,
      104,
      48
     ],
     "varname": "/playing/string",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/string",
       "parameter_shortname": "string",
       "parameter_mmin": 0.0,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-127",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      500,
      104,
      22
     ],
     "text": "0 to 2",
     "presentation": 1,
     "presentation_rect": [
      128,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-128",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2496,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-129",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2496,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/string"
    }
   },
   {
    "box": {
     "id": "obj-130",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      2496,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-131",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2526,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-132",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2526,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/string"
    }
   },
   {
    "box": {
     "id": "obj-133",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      2526,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-134",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      450,
      104,
      48
     ],
     "varname": "/playing/direction",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/direction",
       "parameter_shortname": "direction",
       "parameter_mmin": -1.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-135",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      500,
      104,
      22
     ],
     "text": "-1 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-136",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2556,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-137",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2556,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/direction"
    }
   },
   {
    "box": {
     "id": "obj-138",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      2556,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-139",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2586,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-140",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2586,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/direction"
    }
   },
   {
    "box": {
     "id": "obj-141",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      2586,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-142",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      450,
      104,
      48
     ],
     "varname": "/playing/bow_length",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/bow_length",
       "parameter_shortname": "bow length",
       "parameter_mmin": 0.0,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-143",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      500,
      104,
      22
     ],
     "text": "0 to 2 m",
     "presentation": 1,
     "presentation_rect": [
      352,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-144",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2616,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-145",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2616,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/bow_length"
    }
   },
   {
    "box": {
     "id": "obj-146",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      2616,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-147",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2646,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.7"
    }
   },
   {
    "box": {
     "id": "obj-148",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      2646,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/bow_length"
    }
   },
   {
    "box": {
     "id": "obj-149",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      2646,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-150",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      450,
      104,
      48
     ],
     "varname": "/playing/note_length",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/note_length",
       "parameter_shortname": "note length",
       "parameter_mmin": 0.0,
       "parameter_mmax": 60.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-151",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      500,
      104,
      22
     ],
     "text": "0 to 60 s",
     "presentation": 1,
     "presentation_rect": [
      464,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-152",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2676,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-153",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2676,
      231,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/note_length"
    }
   },
   {
    "box": {
     "id": "obj-154",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      372.0,
      2676,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-155",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2706,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-156",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2706,
      245,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/note_length"
    }
   },
   {
    "box": {
     "id": "obj-157",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      421.0,
      2706,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-158",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      450,
      104,
      48
     ],
     "varname": "/playing/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/press",
       "parameter_shortname": "press",
       "parameter_mmin": 0.3,
       "parameter_mmax": 6.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-159",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      500,
      104,
      22
     ],
     "text": "0.3 to 6 N",
     "presentation": 1,
     "presentation_rect": [
      576,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-160",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2736,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-161",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2736,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/press"
    }
   },
   {
    "box": {
     "id": "obj-162",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      2736,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-163",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2766,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1.5"
    }
   },
   {
    "box": {
     "id": "obj-164",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      2766,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/press"
    }
   },
   {
    "box": {
     "id": "obj-165",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      2766,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-166",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      450,
      104,
      48
     ],
     "varname": "/playing/vibrato",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/vibrato",
       "parameter_shortname": "vibrato",
       "parameter_mmin": 0.0,
       "parameter_mmax": 100.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f cents"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-167",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      500,
      104,
      22
     ],
     "text": "0 to 100 cents",
     "presentation": 1,
     "presentation_rect": [
      688,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-168",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2796,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-169",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2796,
      203,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/vibrato"
    }
   },
   {
    "box": {
     "id": "obj-170",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      344.0,
      2796,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-171",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2826,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-172",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2826,
      217,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/vibrato"
    }
   },
   {
    "box": {
     "id": "obj-173",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      2826,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-174",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      450,
      104,
      48
     ],
     "varname": "/playing/vibrato_press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/vibrato_press",
       "parameter_shortname": "vibrato press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-175",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      500,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      800,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-176",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2856,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-177",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2856,
      245,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/vibrato_press"
    }
   },
   {
    "box": {
     "id": "obj-178",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      386.0,
      2856,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-179",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2886,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-180",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2886,
      259,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/vibrato_press"
    }
   },
   {
    "box": {
     "id": "obj-181",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      435.0,
      2886,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-182",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      912,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      912,
      450,
      104,
      48
     ],
     "varname": "/playing/vibrato_rate",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/vibrato_rate",
       "parameter_shortname": "vibrato rate",
       "parameter_mmin": 2.0,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f Hz"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-183",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      912,
      500,
      104,
      22
     ],
     "text": "2 to 10 Hz",
     "presentation": 1,
     "presentation_rect": [
      912,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-184",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2916,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-185",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2916,
      238,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/vibrato_rate"
    }
   },
   {
    "box": {
     "id": "obj-186",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      379.0,
      2916,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-187",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2946,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 6"
    }
   },
   {
    "box": {
     "id": "obj-188",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      2946,
      252,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/vibrato_rate"
    }
   },
   {
    "box": {
     "id": "obj-189",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      2946,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-190",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      1024,
      450,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      1024,
      450,
      104,
      48
     ],
     "varname": "/playing/vibrato_delay",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/vibrato_delay",
       "parameter_shortname": "vibrato delay",
       "parameter_mmin": 0.0,
       "parameter_mmax": 3000.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f ms"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-191",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      1024,
      500,
      104,
      22
     ],
     "text": "0 to 3000 ms",
     "presentation": 1,
     "presentation_rect": [
      1024,
      500,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-192",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      2976,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-193",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      2976,
      245,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/vibrato_delay"
    }
   },
   {
    "box": {
     "id": "obj-194",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      386.0,
      2976,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-195",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3006,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 500"
    }
   },
   {
    "box": {
     "id": "obj-196",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      3006,
      259,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/vibrato_delay"
    }
   },
   {
    "box": {
     "id": "obj-197",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      449.0,
      3006,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-198",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      548,
      104,
      48
     ],
     "varname": "/playing/bend",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/bend",
       "parameter_shortname": "bend",
       "parameter_mmin": -48.0,
       "parameter_mmax": 48.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f semitones"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-199",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      598,
      104,
      22
     ],
     "text": "-48 to 48 semitones",
     "presentation": 1,
     "presentation_rect": [
      16,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-200",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3036,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-201",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3036,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/bend"
    }
   },
   {
    "box": {
     "id": "obj-202",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      3036,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-203",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3066,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-204",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3066,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/bend"
    }
   },
   {
    "box": {
     "id": "obj-205",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      372.0,
      3066,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-206",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      548,
      104,
      48
     ],
     "varname": "/playing/bend_range",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/bend_range",
       "parameter_shortname": "bend range",
       "parameter_mmin": 0.0,
       "parameter_mmax": 48.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f semitones"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-207",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      598,
      104,
      22
     ],
     "text": "0 to 48 semitones",
     "presentation": 1,
     "presentation_rect": [
      128,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-208",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3096,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-209",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3096,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/bend_range"
    }
   },
   {
    "box": {
     "id": "obj-210",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      3096,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-211",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3126,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 2"
    }
   },
   {
    "box": {
     "id": "obj-212",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3126,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/bend_range"
    }
   },
   {
    "box": {
     "id": "obj-213",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      3126,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-214",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      548,
      104,
      48
     ],
     "varname": "/playing/volume",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/volume",
       "parameter_shortname": "volume",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-215",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-216",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3156,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-217",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3156,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/volume"
    }
   },
   {
    "box": {
     "id": "obj-218",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      3156,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-219",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3186,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-220",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3186,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/volume"
    }
   },
   {
    "box": {
     "id": "obj-221",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      3186,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-222",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      548,
      104,
      48
     ],
     "varname": "/playing/expression",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/expression",
       "parameter_shortname": "expression",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-223",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      352,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-224",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3216,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-225",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3216,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/expression"
    }
   },
   {
    "box": {
     "id": "obj-226",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      3216,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-227",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3246,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-228",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3246,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/expression"
    }
   },
   {
    "box": {
     "id": "obj-229",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      3246,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-230",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      548,
      104,
      48
     ],
     "varname": "/playing/assist",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/assist",
       "parameter_shortname": "assist",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-231",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      464,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-232",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3276,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-233",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3276,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/assist"
    }
   },
   {
    "box": {
     "id": "obj-234",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      3276,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-235",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3306,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-236",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3306,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/assist"
    }
   },
   {
    "box": {
     "id": "obj-237",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      3306,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-238",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      548,
      104,
      48
     ],
     "varname": "/playing/variation",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/variation",
       "parameter_shortname": "variation",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-239",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      576,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-240",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3336,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-241",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3336,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/variation"
    }
   },
   {
    "box": {
     "id": "obj-242",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      3336,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-243",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3366,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.25"
    }
   },
   {
    "box": {
     "id": "obj-244",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      3366,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/variation"
    }
   },
   {
    "box": {
     "id": "obj-245",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      3366,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-246",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      548,
      104,
      48
     ],
     "varname": "/playing/listening",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/listening",
       "parameter_shortname": "listening",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-247",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      688,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-248",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3396,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-249",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3396,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/listening"
    }
   },
   {
    "box": {
     "id": "obj-250",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      3396,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-251",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3426,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-252",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3426,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/listening"
    }
   },
   {
    "box": {
     "id": "obj-253",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      3426,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-254",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      548,
      104,
      48
     ],
     "varname": "/playing/phrasing",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/phrasing",
       "parameter_shortname": "phrasing",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-255",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      800,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-256",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3456,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-257",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3456,
      210,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/phrasing"
    }
   },
   {
    "box": {
     "id": "obj-258",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      351.0,
      3456,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-259",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3486,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-260",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3486,
      224,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/phrasing"
    }
   },
   {
    "box": {
     "id": "obj-261",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      400.0,
      3486,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-262",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      912,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      912,
      548,
      104,
      48
     ],
     "varname": "/playing/left_hand",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/left_hand",
       "parameter_shortname": "left hand",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-263",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      912,
      598,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      912,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-264",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3516,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-265",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3516,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/left_hand"
    }
   },
   {
    "box": {
     "id": "obj-266",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      3516,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-267",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3546,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-268",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3546,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/left_hand"
    }
   },
   {
    "box": {
     "id": "obj-269",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      3546,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-270",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      1024,
      548,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      1024,
      548,
      104,
      48
     ],
     "varname": "/playing/section",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/section",
       "parameter_shortname": "section",
       "parameter_mmin": 1.0,
       "parameter_mmax": 16.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-271",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      1024,
      598,
      104,
      22
     ],
     "text": "1 to 16",
     "presentation": 1,
     "presentation_rect": [
      1024,
      598,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-272",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3576,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-273",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3576,
      203,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/section"
    }
   },
   {
    "box": {
     "id": "obj-274",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      344.0,
      3576,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-275",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3606,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-276",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3606,
      217,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/section"
    }
   },
   {
    "box": {
     "id": "obj-277",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      3606,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-278",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      646,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      646,
      104,
      48
     ],
     "varname": "/playing/attack",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/attack",
       "parameter_shortname": "attack",
       "parameter_mmin": 5.0,
       "parameter_mmax": 500.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f ms"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-279",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      696,
      104,
      22
     ],
     "text": "5 to 500 ms",
     "presentation": 1,
     "presentation_rect": [
      16,
      696,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-280",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3636,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-281",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3636,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/attack"
    }
   },
   {
    "box": {
     "id": "obj-282",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      3636,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-283",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3666,
      119,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 40"
    }
   },
   {
    "box": {
     "id": "obj-284",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      159.0,
      3666,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/attack"
    }
   },
   {
    "box": {
     "id": "obj-285",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      3666,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-286",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      646,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      646,
      104,
      48
     ],
     "varname": "/playing/release",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/release",
       "parameter_shortname": "release",
       "parameter_mmin": 5.0,
       "parameter_mmax": 2000.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f ms"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-287",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      696,
      104,
      22
     ],
     "text": "5 to 2000 ms",
     "presentation": 1,
     "presentation_rect": [
      128,
      696,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-288",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3696,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-289",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3696,
      203,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/release"
    }
   },
   {
    "box": {
     "id": "obj-290",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      344.0,
      3696,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-291",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3726,
      119,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 60"
    }
   },
   {
    "box": {
     "id": "obj-292",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      159.0,
      3726,
      217,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/release"
    }
   },
   {
    "box": {
     "id": "obj-293",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      400.0,
      3726,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-294",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      646,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      646,
      104,
      48
     ],
     "varname": "/playing/portamento",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/portamento",
       "parameter_shortname": "portamento",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-295",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      696,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      696,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-296",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3756,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-297",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3756,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/portamento"
    }
   },
   {
    "box": {
     "id": "obj-298",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      3756,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-299",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3786,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-300",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3786,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/portamento"
    }
   },
   {
    "box": {
     "id": "obj-301",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      3786,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-302",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      646,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      646,
      104,
      48
     ],
     "varname": "/playing/portamento_time",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/playing/portamento_time",
       "parameter_shortname": "portamento time",
       "parameter_mmin": 5.0,
       "parameter_mmax": 2000.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f ms"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-303",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      696,
      104,
      22
     ],
     "text": "5 to 2000 ms",
     "presentation": 1,
     "presentation_rect": [
      352,
      696,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-304",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3816,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-305",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3816,
      259,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/playing/portamento_time"
    }
   },
   {
    "box": {
     "id": "obj-306",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      400.0,
      3816,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-307",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3846,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 120"
    }
   },
   {
    "box": {
     "id": "obj-308",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      3846,
      273,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/playing/portamento_time"
    }
   },
   {
    "box": {
     "id": "obj-309",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      463.0,
      3846,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-310",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      722,
      224,
      22
     ],
     "text": "bow",
     "presentation": 1,
     "presentation_rect": [
      16,
      722,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-311",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      744,
      104,
      48
     ],
     "varname": "/bow/speed",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/speed",
       "parameter_shortname": "speed",
       "parameter_mmin": -2.0,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m/s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-312",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      794,
      104,
      22
     ],
     "text": "-2 to 2 m/s",
     "presentation": 1,
     "presentation_rect": [
      16,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-313",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3876,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-314",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3876,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/speed"
    }
   },
   {
    "box": {
     "id": "obj-315",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      3876,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-316",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3906,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-317",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3906,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/speed"
    }
   },
   {
    "box": {
     "id": "obj-318",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      351.0,
      3906,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-319",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      744,
      104,
      48
     ],
     "varname": "/bow/side",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/side",
       "parameter_shortname": "side",
       "parameter_mmin": -1.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-320",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      794,
      104,
      22
     ],
     "text": "-1 to 1",
     "presentation": 1,
     "presentation_rect": [
      128,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-321",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3936,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-322",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3936,
      154,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/side"
    }
   },
   {
    "box": {
     "id": "obj-323",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      295.0,
      3936,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-324",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3966,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-325",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      3966,
      168,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/side"
    }
   },
   {
    "box": {
     "id": "obj-326",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      344.0,
      3966,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-327",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      744,
      104,
      48
     ],
     "varname": "/bow/force",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/force",
       "parameter_shortname": "force",
       "parameter_mmin": 0.0,
       "parameter_mmax": 5.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-328",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      794,
      104,
      22
     ],
     "text": "0 to 5 N",
     "presentation": 1,
     "presentation_rect": [
      240,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-329",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      3996,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-330",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      3996,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/force"
    }
   },
   {
    "box": {
     "id": "obj-331",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      3996,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-332",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4026,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.5"
    }
   },
   {
    "box": {
     "id": "obj-333",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      4026,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/force"
    }
   },
   {
    "box": {
     "id": "obj-334",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      4026,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-335",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      744,
      104,
      48
     ],
     "varname": "/bow/pressure",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/pressure",
       "parameter_shortname": "pressure",
       "parameter_mmin": 0.0,
       "parameter_mmax": 12.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-336",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      794,
      104,
      22
     ],
     "text": "0 to 12",
     "presentation": 1,
     "presentation_rect": [
      352,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-337",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4056,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-338",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4056,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/pressure"
    }
   },
   {
    "box": {
     "id": "obj-339",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      4056,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-340",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4086,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.4"
    }
   },
   {
    "box": {
     "id": "obj-341",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      4086,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/pressure"
    }
   },
   {
    "box": {
     "id": "obj-342",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      4086,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-343",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      744,
      104,
      48
     ],
     "varname": "/bow/assist",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/assist",
       "parameter_shortname": "assist",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-344",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      794,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      464,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-345",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4116,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-346",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4116,
      168,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/assist"
    }
   },
   {
    "box": {
     "id": "obj-347",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      309.0,
      4116,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-348",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4146,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-349",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4146,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/assist"
    }
   },
   {
    "box": {
     "id": "obj-350",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      358.0,
      4146,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-351",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      744,
      104,
      48
     ],
     "varname": "/bow/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/position",
       "parameter_shortname": "position",
       "parameter_mmin": 0.04,
       "parameter_mmax": 0.5,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-352",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      794,
      104,
      22
     ],
     "text": "0.04 to 0.5",
     "presentation": 1,
     "presentation_rect": [
      576,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-353",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4176,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-354",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4176,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/position"
    }
   },
   {
    "box": {
     "id": "obj-355",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      4176,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-356",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4206,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.13"
    }
   },
   {
    "box": {
     "id": "obj-357",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      4206,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/position"
    }
   },
   {
    "box": {
     "id": "obj-358",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      4206,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-359",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      744,
      104,
      48
     ],
     "varname": "/bow/tremolo",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/tremolo",
       "parameter_shortname": "tremolo",
       "parameter_mmin": 0.0,
       "parameter_mmax": 20.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f 1/s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-360",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      794,
      104,
      22
     ],
     "text": "0 to 20 1/s",
     "presentation": 1,
     "presentation_rect": [
      688,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-361",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4236,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-362",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4236,
      175,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/tremolo"
    }
   },
   {
    "box": {
     "id": "obj-363",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      316.0,
      4236,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-364",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4266,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-365",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4266,
      189,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/tremolo"
    }
   },
   {
    "box": {
     "id": "obj-366",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      4266,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-367",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      744,
      104,
      48
     ],
     "varname": "/bow/tremolo_depth",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/tremolo_depth",
       "parameter_shortname": "tremolo depth",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-368",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      794,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      800,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-369",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4296,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-370",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4296,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/tremolo_depth"
    }
   },
   {
    "box": {
     "id": "obj-371",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      4296,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-372",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4326,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-373",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4326,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/tremolo_depth"
    }
   },
   {
    "box": {
     "id": "obj-374",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      4326,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-375",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      912,
      744,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      912,
      744,
      104,
      48
     ],
     "varname": "/bow/noise",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/bow/noise",
       "parameter_shortname": "noise",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-376",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      912,
      794,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      912,
      794,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-377",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4356,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-378",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4356,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/bow/noise"
    }
   },
   {
    "box": {
     "id": "obj-379",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      4356,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-380",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4386,
      140,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.025"
    }
   },
   {
    "box": {
     "id": "obj-381",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      180.0,
      4386,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/bow/noise"
    }
   },
   {
    "box": {
     "id": "obj-382",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      379.0,
      4386,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-383",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      820,
      224,
      22
     ],
     "text": "finger",
     "presentation": 1,
     "presentation_rect": [
      16,
      820,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-384",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      842,
      104,
      48
     ],
     "varname": "/finger/1/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/1/position",
       "parameter_shortname": "1 position",
       "parameter_mmin": 0.008,
       "parameter_mmax": 0.28,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-385",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      892,
      104,
      22
     ],
     "text": "0.008 to 0.28 m",
     "presentation": 1,
     "presentation_rect": [
      16,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-386",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4416,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-387",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4416,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/1/position"
    }
   },
   {
    "box": {
     "id": "obj-388",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      4416,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-389",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4446,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.05"
    }
   },
   {
    "box": {
     "id": "obj-390",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      4446,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/1/position"
    }
   },
   {
    "box": {
     "id": "obj-391",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      4446,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-392",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      842,
      104,
      48
     ],
     "varname": "/finger/1/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/1/press",
       "parameter_shortname": "1 press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-393",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      892,
      104,
      22
     ],
     "text": "0 to 10 N",
     "presentation": 1,
     "presentation_rect": [
      128,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-394",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4476,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-395",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4476,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/1/press"
    }
   },
   {
    "box": {
     "id": "obj-396",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      4476,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-397",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4506,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-398",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4506,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/1/press"
    }
   },
   {
    "box": {
     "id": "obj-399",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      4506,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-400",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      842,
      104,
      48
     ],
     "varname": "/finger/2/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/2/position",
       "parameter_shortname": "2 position",
       "parameter_mmin": 0.008,
       "parameter_mmax": 0.28,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-401",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      892,
      104,
      22
     ],
     "text": "0.008 to 0.28 m",
     "presentation": 1,
     "presentation_rect": [
      240,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-402",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4536,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-403",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4536,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/2/position"
    }
   },
   {
    "box": {
     "id": "obj-404",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      4536,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-405",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4566,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.05"
    }
   },
   {
    "box": {
     "id": "obj-406",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      4566,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/2/position"
    }
   },
   {
    "box": {
     "id": "obj-407",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      4566,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-408",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      842,
      104,
      48
     ],
     "varname": "/finger/2/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/2/press",
       "parameter_shortname": "2 press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-409",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      892,
      104,
      22
     ],
     "text": "0 to 10 N",
     "presentation": 1,
     "presentation_rect": [
      352,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-410",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4596,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-411",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4596,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/2/press"
    }
   },
   {
    "box": {
     "id": "obj-412",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      4596,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-413",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4626,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-414",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4626,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/2/press"
    }
   },
   {
    "box": {
     "id": "obj-415",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      4626,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-416",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      842,
      104,
      48
     ],
     "varname": "/finger/3/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/3/position",
       "parameter_shortname": "3 position",
       "parameter_mmin": 0.008,
       "parameter_mmax": 0.28,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-417",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      892,
      104,
      22
     ],
     "text": "0.008 to 0.28 m",
     "presentation": 1,
     "presentation_rect": [
      464,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-418",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4656,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-419",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4656,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/3/position"
    }
   },
   {
    "box": {
     "id": "obj-420",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      4656,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-421",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4686,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.05"
    }
   },
   {
    "box": {
     "id": "obj-422",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      4686,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/3/position"
    }
   },
   {
    "box": {
     "id": "obj-423",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      4686,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-424",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      842,
      104,
      48
     ],
     "varname": "/finger/3/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/3/press",
       "parameter_shortname": "3 press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-425",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      892,
      104,
      22
     ],
     "text": "0 to 10 N",
     "presentation": 1,
     "presentation_rect": [
      576,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-426",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4716,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-427",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4716,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/3/press"
    }
   },
   {
    "box": {
     "id": "obj-428",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      4716,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-429",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4746,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-430",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4746,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/3/press"
    }
   },
   {
    "box": {
     "id": "obj-431",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      4746,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-432",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      842,
      104,
      48
     ],
     "varname": "/finger/4/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/4/position",
       "parameter_shortname": "4 position",
       "parameter_mmin": 0.008,
       "parameter_mmax": 0.28,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-433",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      892,
      104,
      22
     ],
     "text": "0.008 to 0.28 m",
     "presentation": 1,
     "presentation_rect": [
      688,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-434",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4776,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-435",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4776,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/4/position"
    }
   },
   {
    "box": {
     "id": "obj-436",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      4776,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-437",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4806,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.05"
    }
   },
   {
    "box": {
     "id": "obj-438",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      4806,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/4/position"
    }
   },
   {
    "box": {
     "id": "obj-439",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      428.0,
      4806,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-440",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      842,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      842,
      104,
      48
     ],
     "varname": "/finger/4/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/finger/4/press",
       "parameter_shortname": "4 press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-441",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      892,
      104,
      22
     ],
     "text": "0 to 10 N",
     "presentation": 1,
     "presentation_rect": [
      800,
      892,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-442",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4836,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-443",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4836,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/finger/4/press"
    }
   },
   {
    "box": {
     "id": "obj-444",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      4836,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-445",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4866,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-446",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4866,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/finger/4/press"
    }
   },
   {
    "box": {
     "id": "obj-447",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      4866,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-448",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      918,
      224,
      22
     ],
     "text": "vibrato",
     "presentation": 1,
     "presentation_rect": [
      16,
      918,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-449",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      940,
      104,
      48
     ],
     "varname": "/vibrato/depth",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/vibrato/depth",
       "parameter_shortname": "depth",
       "parameter_mmin": 0.0,
       "parameter_mmax": 200.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f cents"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-450",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      990,
      104,
      22
     ],
     "text": "0 to 200 cents",
     "presentation": 1,
     "presentation_rect": [
      16,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-451",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4896,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-452",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4896,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/vibrato/depth"
    }
   },
   {
    "box": {
     "id": "obj-453",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      4896,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-454",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4926,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-455",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4926,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/vibrato/depth"
    }
   },
   {
    "box": {
     "id": "obj-456",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      379.0,
      4926,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-457",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      940,
      104,
      48
     ],
     "varname": "/vibrato/press",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/vibrato/press",
       "parameter_shortname": "press",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-458",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      990,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      128,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-459",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4956,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-460",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      4956,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/vibrato/press"
    }
   },
   {
    "box": {
     "id": "obj-461",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      4956,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-462",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      4986,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-463",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      4986,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/vibrato/press"
    }
   },
   {
    "box": {
     "id": "obj-464",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      379.0,
      4986,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-465",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      940,
      104,
      48
     ],
     "varname": "/vibrato/upward",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/vibrato/upward",
       "parameter_shortname": "upward",
       "parameter_mmin": -1.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-466",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      990,
      104,
      22
     ],
     "text": "-1 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-467",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5016,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-468",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5016,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/vibrato/upward"
    }
   },
   {
    "box": {
     "id": "obj-469",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      5016,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-470",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5046,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-471",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5046,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/vibrato/upward"
    }
   },
   {
    "box": {
     "id": "obj-472",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      5046,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-473",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      940,
      104,
      48
     ],
     "varname": "/vibrato/rate",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/vibrato/rate",
       "parameter_shortname": "rate",
       "parameter_mmin": 0.5,
       "parameter_mmax": 12.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f Hz"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-474",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      990,
      104,
      22
     ],
     "text": "0.5 to 12 Hz",
     "presentation": 1,
     "presentation_rect": [
      352,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-475",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5076,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-476",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5076,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/vibrato/rate"
    }
   },
   {
    "box": {
     "id": "obj-477",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      5076,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-478",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5106,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 6"
    }
   },
   {
    "box": {
     "id": "obj-479",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5106,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/vibrato/rate"
    }
   },
   {
    "box": {
     "id": "obj-480",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      372.0,
      5106,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-481",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      940,
      104,
      48
     ],
     "varname": "/vibrato/onset",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/vibrato/onset",
       "parameter_shortname": "onset",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-482",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      990,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      464,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-483",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5136,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-484",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5136,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/vibrato/onset"
    }
   },
   {
    "box": {
     "id": "obj-485",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      5136,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-486",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5166,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-487",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5166,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/vibrato/onset"
    }
   },
   {
    "box": {
     "id": "obj-488",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      379.0,
      5166,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-489",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      918,
      224,
      22
     ],
     "text": "pluck",
     "presentation": 1,
     "presentation_rect": [
      576,
      918,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-490",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      940,
      104,
      48
     ],
     "varname": "/pluck/force",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/pluck/force",
       "parameter_shortname": "force",
       "parameter_mmin": -5.0,
       "parameter_mmax": 5.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f N"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-491",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      990,
      104,
      22
     ],
     "text": "-5 to 5 N",
     "presentation": 1,
     "presentation_rect": [
      576,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-492",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5196,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-493",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5196,
      175,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/pluck/force"
    }
   },
   {
    "box": {
     "id": "obj-494",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      316.0,
      5196,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-495",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5226,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-496",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5226,
      189,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/pluck/force"
    }
   },
   {
    "box": {
     "id": "obj-497",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      5226,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-498",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      940,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      940,
      104,
      48
     ],
     "varname": "/pluck/position",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/pluck/position",
       "parameter_shortname": "position",
       "parameter_mmin": 0.05,
       "parameter_mmax": 0.9,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-499",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      990,
      104,
      22
     ],
     "text": "0.05 to 0.9",
     "presentation": 1,
     "presentation_rect": [
      688,
      990,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-500",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5256,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-501",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5256,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/pluck/position"
    }
   },
   {
    "box": {
     "id": "obj-502",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      5256,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-503",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5286,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.3"
    }
   },
   {
    "box": {
     "id": "obj-504",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      5286,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/pluck/position"
    }
   },
   {
    "box": {
     "id": "obj-505",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      400.0,
      5286,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-506",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1016,
      224,
      22
     ],
     "text": "string",
     "presentation": 1,
     "presentation_rect": [
      16,
      1016,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-507",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      1038,
      104,
      48
     ],
     "varname": "/string/inner/tuning",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/string/inner/tuning",
       "parameter_shortname": "inner tuning",
       "parameter_mmin": -200.0,
       "parameter_mmax": 40.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f cents"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-508",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1088,
      104,
      22
     ],
     "text": "-200 to 40 cents",
     "presentation": 1,
     "presentation_rect": [
      16,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-509",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5316,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-510",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5316,
      231,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/string/inner/tuning"
    }
   },
   {
    "box": {
     "id": "obj-511",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      372.0,
      5316,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-512",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5346,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-513",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5346,
      245,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/string/inner/tuning"
    }
   },
   {
    "box": {
     "id": "obj-514",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      421.0,
      5346,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-515",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      1038,
      104,
      48
     ],
     "varname": "/string/inner/loss",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/string/inner/loss",
       "parameter_shortname": "inner loss",
       "parameter_mmin": 0.25,
       "parameter_mmax": 4.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-516",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      1088,
      104,
      22
     ],
     "text": "0.25 to 4",
     "presentation": 1,
     "presentation_rect": [
      128,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-517",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5376,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-518",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5376,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/string/inner/loss"
    }
   },
   {
    "box": {
     "id": "obj-519",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      5376,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-520",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5406,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-521",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5406,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/string/inner/loss"
    }
   },
   {
    "box": {
     "id": "obj-522",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      5406,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-523",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      1038,
      104,
      48
     ],
     "varname": "/string/outer/tuning",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/string/outer/tuning",
       "parameter_shortname": "outer tuning",
       "parameter_mmin": -200.0,
       "parameter_mmax": 40.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f cents"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-524",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      1088,
      104,
      22
     ],
     "text": "-200 to 40 cents",
     "presentation": 1,
     "presentation_rect": [
      240,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-525",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5436,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-526",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5436,
      231,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/string/outer/tuning"
    }
   },
   {
    "box": {
     "id": "obj-527",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      372.0,
      5436,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-528",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5466,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-529",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5466,
      245,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/string/outer/tuning"
    }
   },
   {
    "box": {
     "id": "obj-530",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      421.0,
      5466,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-531",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      1038,
      104,
      48
     ],
     "varname": "/string/outer/loss",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/string/outer/loss",
       "parameter_shortname": "outer loss",
       "parameter_mmin": 0.25,
       "parameter_mmax": 4.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-532",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      1088,
      104,
      22
     ],
     "text": "0.25 to 4",
     "presentation": 1,
     "presentation_rect": [
      352,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-533",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5496,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-534",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5496,
      217,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/string/outer/loss"
    }
   },
   {
    "box": {
     "id": "obj-535",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      358.0,
      5496,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-536",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5526,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-537",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5526,
      231,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/string/outer/loss"
    }
   },
   {
    "box": {
     "id": "obj-538",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      407.0,
      5526,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-539",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      1016,
      224,
      22
     ],
     "text": "output",
     "presentation": 1,
     "presentation_rect": [
      464,
      1016,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-540",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      1038,
      104,
      48
     ],
     "varname": "/output/gain",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/output/gain",
       "parameter_shortname": "gain",
       "parameter_mmin": -60.0,
       "parameter_mmax": 24.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f dB"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-541",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      1088,
      104,
      22
     ],
     "text": "-60 to 24 dB",
     "presentation": 1,
     "presentation_rect": [
      464,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-542",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5556,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-543",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5556,
      175,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/output/gain"
    }
   },
   {
    "box": {
     "id": "obj-544",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      316.0,
      5556,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-545",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5586,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-546",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5586,
      189,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/output/gain"
    }
   },
   {
    "box": {
     "id": "obj-547",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      5586,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-548",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      1038,
      104,
      48
     ],
     "varname": "/output/level",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/output/level",
       "parameter_shortname": "level",
       "parameter_mmin": 0.0,
       "parameter_mmax": 2.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-549",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      1088,
      104,
      22
     ],
     "text": "0 to 2",
     "presentation": 1,
     "presentation_rect": [
      576,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-550",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5616,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-551",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5616,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/output/level"
    }
   },
   {
    "box": {
     "id": "obj-552",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      5616,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-553",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5646,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-554",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5646,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/output/level"
    }
   },
   {
    "box": {
     "id": "obj-555",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      372.0,
      5646,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-556",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      1038,
      104,
      48
     ],
     "varname": "/output/balance",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/output/balance",
       "parameter_shortname": "balance",
       "parameter_mmin": -36.0,
       "parameter_mmax": 36.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f dB"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-557",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      1088,
      104,
      22
     ],
     "text": "-36 to 36 dB",
     "presentation": 1,
     "presentation_rect": [
      688,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-558",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5676,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-559",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5676,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/output/balance"
    }
   },
   {
    "box": {
     "id": "obj-560",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      5676,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-561",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5706,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-562",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5706,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/output/balance"
    }
   },
   {
    "box": {
     "id": "obj-563",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      5706,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-564",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      1038,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      1038,
      104,
      48
     ],
     "varname": "/output/limiter",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/output/limiter",
       "parameter_shortname": "limiter",
       "parameter_mmin": -24.0,
       "parameter_mmax": 0.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f dB"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-565",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      1088,
      104,
      22
     ],
     "text": "-24 to 0 dB",
     "presentation": 1,
     "presentation_rect": [
      800,
      1088,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-566",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5736,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-567",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5736,
      196,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/output/limiter"
    }
   },
   {
    "box": {
     "id": "obj-568",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      337.0,
      5736,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-569",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5766,
      119,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set -3"
    }
   },
   {
    "box": {
     "id": "obj-570",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      159.0,
      5766,
      210,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/output/limiter"
    }
   },
   {
    "box": {
     "id": "obj-571",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      5766,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-572",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1114,
      224,
      22
     ],
     "text": "body",
     "presentation": 1,
     "presentation_rect": [
      16,
      1114,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-573",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      1136,
      104,
      48
     ],
     "varname": "/body/gain",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/gain",
       "parameter_shortname": "gain",
       "parameter_mmin": -24.0,
       "parameter_mmax": 24.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f dB"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-574",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1186,
      104,
      22
     ],
     "text": "-24 to 24 dB",
     "presentation": 1,
     "presentation_rect": [
      16,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-575",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5796,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-576",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5796,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/gain"
    }
   },
   {
    "box": {
     "id": "obj-577",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      5796,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-578",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5826,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-579",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5826,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/gain"
    }
   },
   {
    "box": {
     "id": "obj-580",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      351.0,
      5826,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-581",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      1136,
      104,
      48
     ],
     "varname": "/body/blend",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/blend",
       "parameter_shortname": "blend",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-582",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      1186,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      128,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-583",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5856,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-584",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5856,
      168,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/blend"
    }
   },
   {
    "box": {
     "id": "obj-585",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      309.0,
      5856,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-586",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5886,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-587",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      5886,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/blend"
    }
   },
   {
    "box": {
     "id": "obj-588",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      358.0,
      5886,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-589",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      1136,
      104,
      48
     ],
     "varname": "/body/width",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/width",
       "parameter_shortname": "width",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-590",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      1186,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-591",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5916,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-592",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5916,
      168,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/width"
    }
   },
   {
    "box": {
     "id": "obj-593",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      309.0,
      5916,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-594",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5946,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.3"
    }
   },
   {
    "box": {
     "id": "obj-595",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      5946,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/width"
    }
   },
   {
    "box": {
     "id": "obj-596",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      372.0,
      5946,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-597",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      1136,
      104,
      48
     ],
     "varname": "/body/sway",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/sway",
       "parameter_shortname": "sway",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-598",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      1186,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      352,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-599",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      5976,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-600",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      5976,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/sway"
    }
   },
   {
    "box": {
     "id": "obj-601",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      5976,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-602",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6006,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.5"
    }
   },
   {
    "box": {
     "id": "obj-603",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      6006,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/sway"
    }
   },
   {
    "box": {
     "id": "obj-604",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      6006,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-605",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      1136,
      104,
      48
     ],
     "varname": "/body/brilliance",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/brilliance",
       "parameter_shortname": "brilliance",
       "parameter_mmin": -24.0,
       "parameter_mmax": 24.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f dB"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-606",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      1186,
      104,
      22
     ],
     "text": "-24 to 24 dB",
     "presentation": 1,
     "presentation_rect": [
      464,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-607",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6036,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-608",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6036,
      203,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/brilliance"
    }
   },
   {
    "box": {
     "id": "obj-609",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      344.0,
      6036,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-610",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6066,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-611",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      6066,
      217,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/brilliance"
    }
   },
   {
    "box": {
     "id": "obj-612",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      6066,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-613",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      1136,
      104,
      48
     ],
     "varname": "/body/brilliance_frequency",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/brilliance_frequency",
       "parameter_shortname": "brilliance frequency",
       "parameter_mmin": 200.0,
       "parameter_mmax": 8000.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f Hz"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-614",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      1186,
      104,
      22
     ],
     "text": "200 to 8000 Hz",
     "presentation": 1,
     "presentation_rect": [
      576,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-615",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6096,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-616",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6096,
      273,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/brilliance_frequency"
    }
   },
   {
    "box": {
     "id": "obj-617",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      414.0,
      6096,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-618",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6126,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1300"
    }
   },
   {
    "box": {
     "id": "obj-619",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      6126,
      287,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/brilliance_frequency"
    }
   },
   {
    "box": {
     "id": "obj-620",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      484.0,
      6126,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-621",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      1136,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      1136,
      104,
      48
     ],
     "varname": "/body/evenness",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/body/evenness",
       "parameter_shortname": "evenness",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-622",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      1186,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      688,
      1186,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-623",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6156,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-624",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6156,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/body/evenness"
    }
   },
   {
    "box": {
     "id": "obj-625",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      6156,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-626",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6186,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.9"
    }
   },
   {
    "box": {
     "id": "obj-627",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      6186,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/body/evenness"
    }
   },
   {
    "box": {
     "id": "obj-628",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      6186,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-629",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1212,
      224,
      22
     ],
     "text": "room",
     "presentation": 1,
     "presentation_rect": [
      16,
      1212,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-630",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      16,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      16,
      1234,
      104,
      48
     ],
     "varname": "/room/size",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/size",
       "parameter_shortname": "size",
       "parameter_mmin": 2.0,
       "parameter_mmax": 40.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-631",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      16,
      1284,
      104,
      22
     ],
     "text": "2 to 40 m",
     "presentation": 1,
     "presentation_rect": [
      16,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-632",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6216,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-633",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6216,
      161,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/size"
    }
   },
   {
    "box": {
     "id": "obj-634",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      302.0,
      6216,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-635",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6246,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 7"
    }
   },
   {
    "box": {
     "id": "obj-636",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      6246,
      175,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/size"
    }
   },
   {
    "box": {
     "id": "obj-637",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      351.0,
      6246,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-638",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      128,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      128,
      1234,
      104,
      48
     ],
     "varname": "/room/decay",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/decay",
       "parameter_shortname": "decay",
       "parameter_mmin": 0.1,
       "parameter_mmax": 10.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f s"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-639",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      128,
      1284,
      104,
      22
     ],
     "text": "0.1 to 10 s",
     "presentation": 1,
     "presentation_rect": [
      128,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-640",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6276,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-641",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6276,
      168,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/decay"
    }
   },
   {
    "box": {
     "id": "obj-642",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      309.0,
      6276,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-643",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6306,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.7"
    }
   },
   {
    "box": {
     "id": "obj-644",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      6306,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/decay"
    }
   },
   {
    "box": {
     "id": "obj-645",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      372.0,
      6306,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-646",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      240,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      240,
      1234,
      104,
      48
     ],
     "varname": "/room/damping",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/damping",
       "parameter_shortname": "damping",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-647",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      240,
      1284,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      240,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-648",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6336,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-649",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6336,
      182,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/damping"
    }
   },
   {
    "box": {
     "id": "obj-650",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      323.0,
      6336,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-651",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6366,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.2"
    }
   },
   {
    "box": {
     "id": "obj-652",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      6366,
      196,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/damping"
    }
   },
   {
    "box": {
     "id": "obj-653",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      386.0,
      6366,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-654",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      352,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      352,
      1234,
      104,
      48
     ],
     "varname": "/room/level",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/level",
       "parameter_shortname": "level",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-655",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      352,
      1284,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      352,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-656",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6396,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-657",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6396,
      168,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/level"
    }
   },
   {
    "box": {
     "id": "obj-658",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      309.0,
      6396,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-659",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6426,
      133,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0.45"
    }
   },
   {
    "box": {
     "id": "obj-660",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      173.0,
      6426,
      182,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/level"
    }
   },
   {
    "box": {
     "id": "obj-661",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      379.0,
      6426,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-662",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      464,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      464,
      1234,
      104,
      48
     ],
     "varname": "/room/distance",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/distance",
       "parameter_shortname": "distance",
       "parameter_mmin": 1.0,
       "parameter_mmax": 20.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f m"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-663",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      464,
      1284,
      104,
      22
     ],
     "text": "1 to 20 m",
     "presentation": 1,
     "presentation_rect": [
      464,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-664",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6456,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-665",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6456,
      189,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/distance"
    }
   },
   {
    "box": {
     "id": "obj-666",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      330.0,
      6456,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-667",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6486,
      126,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 3.5"
    }
   },
   {
    "box": {
     "id": "obj-668",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      166.0,
      6486,
      203,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/distance"
    }
   },
   {
    "box": {
     "id": "obj-669",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      393.0,
      6486,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-670",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      576,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      576,
      1234,
      104,
      48
     ],
     "varname": "/room/pan",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/room/pan",
       "parameter_shortname": "pan",
       "parameter_mmin": -1.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-671",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      576,
      1284,
      104,
      22
     ],
     "text": "-1 to 1",
     "presentation": 1,
     "presentation_rect": [
      576,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-672",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6516,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-673",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6516,
      154,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/room/pan"
    }
   },
   {
    "box": {
     "id": "obj-674",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      295.0,
      6516,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-675",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6546,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-676",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      6546,
      168,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/room/pan"
    }
   },
   {
    "box": {
     "id": "obj-677",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      344.0,
      6546,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-678",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      1212,
      224,
      22
     ],
     "text": "engine",
     "presentation": 1,
     "presentation_rect": [
      688,
      1212,
      224,
      22
     ],
     "fontface": 1
    }
   },
   {
    "box": {
     "id": "obj-679",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      688,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      688,
      1234,
      104,
      48
     ],
     "varname": "/engine/calibration",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/engine/calibration",
       "parameter_shortname": "calibration",
       "parameter_mmin": 0.0,
       "parameter_mmax": 1.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-680",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      688,
      1284,
      104,
      22
     ],
     "text": "0 to 1",
     "presentation": 1,
     "presentation_rect": [
      688,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-681",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6576,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-682",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6576,
      224,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/engine/calibration"
    }
   },
   {
    "box": {
     "id": "obj-683",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      365.0,
      6576,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-684",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6606,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 1"
    }
   },
   {
    "box": {
     "id": "obj-685",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      6606,
      238,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/engine/calibration"
    }
   },
   {
    "box": {
     "id": "obj-686",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      414.0,
      6606,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   },
   {
    "box": {
     "id": "obj-687",
     "maxclass": "live.dial",
     "numinlets": 1,
     "numoutlets": 2,
     "patching_rect": [
      800,
      1234,
      104,
      48
     ],
     "outlettype": [
      "int/float",
      "int/float"
     ],
     "presentation": 1,
     "presentation_rect": [
      800,
      1234,
      104,
      48
     ],
     "varname": "/engine/seed",
     "parameter_enable": 1,
     "saved_attribute_attributes": {
      "valueof": {
       "parameter_longname": "/engine/seed",
       "parameter_shortname": "seed",
       "parameter_mmin": 0.0,
       "parameter_mmax": 65535.0,
       "parameter_type": 0,
       "parameter_unitstyle": 9,
       "parameter_units": "%.3f"
      }
     }
    }
   },
   {
    "box": {
     "id": "obj-688",
     "maxclass": "comment",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      800,
      1284,
      104,
      22
     ],
     "text": "0 to 65535",
     "presentation": 1,
     "presentation_rect": [
      800,
      1284,
      104,
      22
     ],
     "textjustification": 1,
     "fontsize": 9.0
    }
   },
   {
    "box": {
     "id": "obj-689",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6636,
      77,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "r yehu.in"
    }
   },
   {
    "box": {
     "id": "obj-690",
     "maxclass": "newobj",
     "numinlets": 2,
     "numoutlets": 2,
     "patching_rect": [
      117.0,
      6636,
      175,
      22
     ],
     "outlettype": [
      "",
      ""
     ],
     "text": "route /yehu/engine/seed"
    }
   },
   {
    "box": {
     "id": "obj-691",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      316.0,
      6636,
      91,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend set"
    }
   },
   {
    "box": {
     "id": "obj-692",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      16.0,
      6666,
      112,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "loadmess set 0"
    }
   },
   {
    "box": {
     "id": "obj-693",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 1,
     "patching_rect": [
      152.0,
      6666,
      189,
      22
     ],
     "outlettype": [
      ""
     ],
     "text": "prepend /yehu/engine/seed"
    }
   },
   {
    "box": {
     "id": "obj-694",
     "maxclass": "newobj",
     "numinlets": 1,
     "numoutlets": 0,
     "patching_rect": [
      365.0,
      6666,
      98,
      22
     ],
     "outlettype": [],
     "text": "s yehu.moved"
    }
   }
  ],
  "lines": [
   {
    "patchline": {
     "source": [
      "obj-2",
      0
     ],
     "destination": [
      "obj-3",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-3",
      0
     ],
     "destination": [
      "obj-4",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-4",
      0
     ],
     "destination": [
      "obj-5",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-5",
      0
     ],
     "destination": [
      "obj-1",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-6",
      0
     ],
     "destination": [
      "obj-1",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-7",
      0
     ],
     "destination": [
      "obj-1",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-7",
      0
     ],
     "destination": [
      "obj-8",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-8",
      0
     ],
     "destination": [
      "obj-9",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-9",
      0
     ],
     "destination": [
      "obj-10",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-10",
      0
     ],
     "destination": [
      "obj-5",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-8",
      1
     ],
     "destination": [
      "obj-11",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-11",
      0
     ],
     "destination": [
      "obj-12",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-12",
      0
     ],
     "destination": [
      "obj-13",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-10",
      1
     ],
     "destination": [
      "obj-14",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-14",
      0
     ],
     "destination": [
      "obj-12",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-15",
      0
     ],
     "destination": [
      "obj-12",
      1
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-19",
      0
     ],
     "destination": [
      "obj-20",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-20",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-18",
      0
     ],
     "destination": [
      "obj-21",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-21",
      0
     ],
     "destination": [
      "obj-19",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-22",
      0
     ],
     "destination": [
      "obj-23",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-23",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-18",
      1
     ],
     "destination": [
      "obj-24",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-24",
      0
     ],
     "destination": [
      "obj-22",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-27",
      0
     ],
     "destination": [
      "obj-28",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-28",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-26",
      0
     ],
     "destination": [
      "obj-29",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-29",
      0
     ],
     "destination": [
      "obj-27",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-26",
      1
     ],
     "destination": [
      "obj-30",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-30",
      0
     ],
     "destination": [
      "obj-27",
      1
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-31",
      0
     ],
     "destination": [
      "obj-32",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-32",
      0
     ],
     "destination": [
      "obj-33",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-33",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-31",
      1
     ],
     "destination": [
      "obj-32",
      1
     ],
     "order": 1
    }
   },
   {
    "patchline": {
     "source": [
      "obj-34",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-35",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-36",
      0
     ],
     "destination": [
      "obj-16",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-40",
      0
     ],
     "destination": [
      "obj-41",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-41",
      0
     ],
     "destination": [
      "obj-42",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-42",
      0
     ],
     "destination": [
      "obj-38",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-43",
      0
     ],
     "destination": [
      "obj-38",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-38",
      0
     ],
     "destination": [
      "obj-44",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-44",
      0
     ],
     "destination": [
      "obj-45",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-48",
      0
     ],
     "destination": [
      "obj-49",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-49",
      0
     ],
     "destination": [
      "obj-50",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-50",
      0
     ],
     "destination": [
      "obj-46",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-51",
      0
     ],
     "destination": [
      "obj-46",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-46",
      0
     ],
     "destination": [
      "obj-52",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-52",
      0
     ],
     "destination": [
      "obj-53",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-56",
      0
     ],
     "destination": [
      "obj-57",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-57",
      0
     ],
     "destination": [
      "obj-58",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-58",
      0
     ],
     "destination": [
      "obj-54",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-59",
      0
     ],
     "destination": [
      "obj-54",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-54",
      0
     ],
     "destination": [
      "obj-60",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-60",
      0
     ],
     "destination": [
      "obj-61",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-64",
      0
     ],
     "destination": [
      "obj-65",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-65",
      0
     ],
     "destination": [
      "obj-66",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-66",
      0
     ],
     "destination": [
      "obj-62",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-67",
      0
     ],
     "destination": [
      "obj-62",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-62",
      0
     ],
     "destination": [
      "obj-68",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-68",
      0
     ],
     "destination": [
      "obj-69",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-72",
      0
     ],
     "destination": [
      "obj-73",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-73",
      0
     ],
     "destination": [
      "obj-74",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-74",
      0
     ],
     "destination": [
      "obj-70",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-75",
      0
     ],
     "destination": [
      "obj-70",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-70",
      0
     ],
     "destination": [
      "obj-76",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-76",
      0
     ],
     "destination": [
      "obj-77",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-80",
      0
     ],
     "destination": [
      "obj-81",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-81",
      0
     ],
     "destination": [
      "obj-82",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-82",
      0
     ],
     "destination": [
      "obj-78",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-83",
      0
     ],
     "destination": [
      "obj-78",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-78",
      0
     ],
     "destination": [
      "obj-84",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-84",
      0
     ],
     "destination": [
      "obj-85",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-88",
      0
     ],
     "destination": [
      "obj-89",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-89",
      0
     ],
     "destination": [
      "obj-90",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-90",
      0
     ],
     "destination": [
      "obj-86",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-91",
      0
     ],
     "destination": [
      "obj-86",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-86",
      0
     ],
     "destination": [
      "obj-92",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-92",
      0
     ],
     "destination": [
      "obj-93",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-96",
      0
     ],
     "destination": [
      "obj-97",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-97",
      0
     ],
     "destination": [
      "obj-98",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-98",
      0
     ],
     "destination": [
      "obj-94",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-99",
      0
     ],
     "destination": [
      "obj-94",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-94",
      0
     ],
     "destination": [
      "obj-100",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-100",
      0
     ],
     "destination": [
      "obj-101",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-104",
      0
     ],
     "destination": [
      "obj-105",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-105",
      0
     ],
     "destination": [
      "obj-106",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-106",
      0
     ],
     "destination": [
      "obj-102",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-107",
      0
     ],
     "destination": [
      "obj-102",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-102",
      0
     ],
     "destination": [
      "obj-108",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-108",
      0
     ],
     "destination": [
      "obj-109",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-112",
      0
     ],
     "destination": [
      "obj-113",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-113",
      0
     ],
     "destination": [
      "obj-114",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-114",
      0
     ],
     "destination": [
      "obj-110",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-115",
      0
     ],
     "destination": [
      "obj-110",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-110",
      0
     ],
     "destination": [
      "obj-116",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-116",
      0
     ],
     "destination": [
      "obj-117",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-120",
      0
     ],
     "destination": [
      "obj-121",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-121",
      0
     ],
     "destination": [
      "obj-122",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-122",
      0
     ],
     "destination": [
      "obj-118",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-123",
      0
     ],
     "destination": [
      "obj-118",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-118",
      0
     ],
     "destination": [
      "obj-124",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-124",
      0
     ],
     "destination": [
      "obj-125",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-128",
      0
     ],
     "destination": [
      "obj-129",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-129",
      0
     ],
     "destination": [
      "obj-130",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-130",
      0
     ],
     "destination": [
      "obj-126",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-131",
      0
     ],
     "destination": [
      "obj-126",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-126",
      0
     ],
     "destination": [
      "obj-132",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-132",
      0
     ],
     "destination": [
      "obj-133",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-136",
      0
     ],
     "destination": [
      "obj-137",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-137",
      0
     ],
     "destination": [
      "obj-138",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-138",
      0
     ],
     "destination": [
      "obj-134",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-139",
      0
     ],
     "destination": [
      "obj-134",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-134",
      0
     ],
     "destination": [
      "obj-140",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-140",
      0
     ],
     "destination": [
      "obj-141",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-144",
      0
     ],
     "destination": [
      "obj-145",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-145",
      0
     ],
     "destination": [
      "obj-146",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-146",
      0
     ],
     "destination": [
      "obj-142",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-147",
      0
     ],
     "destination": [
      "obj-142",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-142",
      0
     ],
     "destination": [
      "obj-148",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-148",
      0
     ],
     "destination": [
      "obj-149",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-152",
      0
     ],
     "destination": [
      "obj-153",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-153",
      0
     ],
     "destination": [
      "obj-154",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-154",
      0
     ],
     "destination": [
      "obj-150",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-155",
      0
     ],
     "destination": [
      "obj-150",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-150",
      0
     ],
     "destination": [
      "obj-156",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-156",
      0
     ],
     "destination": [
      "obj-157",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-160",
      0
     ],
     "destination": [
      "obj-161",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-161",
      0
     ],
     "destination": [
      "obj-162",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-162",
      0
     ],
     "destination": [
      "obj-158",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-163",
      0
     ],
     "destination": [
      "obj-158",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-158",
      0
     ],
     "destination": [
      "obj-164",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-164",
      0
     ],
     "destination": [
      "obj-165",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-168",
      0
     ],
     "destination": [
      "obj-169",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-169",
      0
     ],
     "destination": [
      "obj-170",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-170",
      0
     ],
     "destination": [
      "obj-166",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-171",
      0
     ],
     "destination": [
      "obj-166",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-166",
      0
     ],
     "destination": [
      "obj-172",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-172",
      0
     ],
     "destination": [
      "obj-173",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-176",
      0
     ],
     "destination": [
      "obj-177",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-177",
      0
     ],
     "destination": [
      "obj-178",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-178",
      0
     ],
     "destination": [
      "obj-174",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-179",
      0
     ],
     "destination": [
      "obj-174",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-174",
      0
     ],
     "destination": [
      "obj-180",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-180",
      0
     ],
     "destination": [
      "obj-181",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-184",
      0
     ],
     "destination": [
      "obj-185",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-185",
      0
     ],
     "destination": [
      "obj-186",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-186",
      0
     ],
     "destination": [
      "obj-182",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-187",
      0
     ],
     "destination": [
      "obj-182",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-182",
      0
     ],
     "destination": [
      "obj-188",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-188",
      0
     ],
     "destination": [
      "obj-189",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-192",
      0
     ],
     "destination": [
      "obj-193",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-193",
      0
     ],
     "destination": [
      "obj-194",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-194",
      0
     ],
     "destination": [
      "obj-190",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-195",
      0
     ],
     "destination": [
      "obj-190",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-190",
      0
     ],
     "destination": [
      "obj-196",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-196",
      0
     ],
     "destination": [
      "obj-197",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-200",
      0
     ],
     "destination": [
      "obj-201",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-201",
      0
     ],
     "destination": [
      "obj-202",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-202",
      0
     ],
     "destination": [
      "obj-198",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-203",
      0
     ],
     "destination": [
      "obj-198",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-198",
      0
     ],
     "destination": [
      "obj-204",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-204",
      0
     ],
     "destination": [
      "obj-205",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-208",
      0
     ],
     "destination": [
      "obj-209",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-209",
      0
     ],
     "destination": [
      "obj-210",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-210",
      0
     ],
     "destination": [
      "obj-206",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-211",
      0
     ],
     "destination": [
      "obj-206",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-206",
      0
     ],
     "destination": [
      "obj-212",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-212",
      0
     ],
     "destination": [
      "obj-213",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-216",
      0
     ],
     "destination": [
      "obj-217",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-217",
      0
     ],
     "destination": [
      "obj-218",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-218",
      0
     ],
     "destination": [
      "obj-214",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-219",
      0
     ],
     "destination": [
      "obj-214",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-214",
      0
     ],
     "destination": [
      "obj-220",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-220",
      0
     ],
     "destination": [
      "obj-221",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-224",
      0
     ],
     "destination": [
      "obj-225",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-225",
      0
     ],
     "destination": [
      "obj-226",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-226",
      0
     ],
     "destination": [
      "obj-222",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-227",
      0
     ],
     "destination": [
      "obj-222",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-222",
      0
     ],
     "destination": [
      "obj-228",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-228",
      0
     ],
     "destination": [
      "obj-229",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-232",
      0
     ],
     "destination": [
      "obj-233",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-233",
      0
     ],
     "destination": [
      "obj-234",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-234",
      0
     ],
     "destination": [
      "obj-230",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-235",
      0
     ],
     "destination": [
      "obj-230",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-230",
      0
     ],
     "destination": [
      "obj-236",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-236",
      0
     ],
     "destination": [
      "obj-237",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-240",
      0
     ],
     "destination": [
      "obj-241",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-241",
      0
     ],
     "destination": [
      "obj-242",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-242",
      0
     ],
     "destination": [
      "obj-238",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-243",
      0
     ],
     "destination": [
      "obj-238",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-238",
      0
     ],
     "destination": [
      "obj-244",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-244",
      0
     ],
     "destination": [
      "obj-245",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-248",
      0
     ],
     "destination": [
      "obj-249",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-249",
      0
     ],
     "destination": [
      "obj-250",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-250",
      0
     ],
     "destination": [
      "obj-246",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-251",
      0
     ],
     "destination": [
      "obj-246",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-246",
      0
     ],
     "destination": [
      "obj-252",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-252",
      0
     ],
     "destination": [
      "obj-253",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-256",
      0
     ],
     "destination": [
      "obj-257",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-257",
      0
     ],
     "destination": [
      "obj-258",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-258",
      0
     ],
     "destination": [
      "obj-254",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-259",
      0
     ],
     "destination": [
      "obj-254",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-254",
      0
     ],
     "destination": [
      "obj-260",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-260",
      0
     ],
     "destination": [
      "obj-261",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-264",
      0
     ],
     "destination": [
      "obj-265",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-265",
      0
     ],
     "destination": [
      "obj-266",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-266",
      0
     ],
     "destination": [
      "obj-262",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-267",
      0
     ],
     "destination": [
      "obj-262",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-262",
      0
     ],
     "destination": [
      "obj-268",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-268",
      0
     ],
     "destination": [
      "obj-269",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-272",
      0
     ],
     "destination": [
      "obj-273",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-273",
      0
     ],
     "destination": [
      "obj-274",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-274",
      0
     ],
     "destination": [
      "obj-270",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-275",
      0
     ],
     "destination": [
      "obj-270",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-270",
      0
     ],
     "destination": [
      "obj-276",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-276",
      0
     ],
     "destination": [
      "obj-277",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-280",
      0
     ],
     "destination": [
      "obj-281",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-281",
      0
     ],
     "destination": [
      "obj-282",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-282",
      0
     ],
     "destination": [
      "obj-278",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-283",
      0
     ],
     "destination": [
      "obj-278",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-278",
      0
     ],
     "destination": [
      "obj-284",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-284",
      0
     ],
     "destination": [
      "obj-285",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-288",
      0
     ],
     "destination": [
      "obj-289",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-289",
      0
     ],
     "destination": [
      "obj-290",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-290",
      0
     ],
     "destination": [
      "obj-286",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-291",
      0
     ],
     "destination": [
      "obj-286",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-286",
      0
     ],
     "destination": [
      "obj-292",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-292",
      0
     ],
     "destination": [
      "obj-293",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-296",
      0
     ],
     "destination": [
      "obj-297",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-297",
      0
     ],
     "destination": [
      "obj-298",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-298",
      0
     ],
     "destination": [
      "obj-294",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-299",
      0
     ],
     "destination": [
      "obj-294",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-294",
      0
     ],
     "destination": [
      "obj-300",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-300",
      0
     ],
     "destination": [
      "obj-301",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-304",
      0
     ],
     "destination": [
      "obj-305",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-305",
      0
     ],
     "destination": [
      "obj-306",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-306",
      0
     ],
     "destination": [
      "obj-302",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-307",
      0
     ],
     "destination": [
      "obj-302",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-302",
      0
     ],
     "destination": [
      "obj-308",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-308",
      0
     ],
     "destination": [
      "obj-309",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-313",
      0
     ],
     "destination": [
      "obj-314",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-314",
      0
     ],
     "destination": [
      "obj-315",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-315",
      0
     ],
     "destination": [
      "obj-311",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-316",
      0
     ],
     "destination": [
      "obj-311",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-311",
      0
     ],
     "destination": [
      "obj-317",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-317",
      0
     ],
     "destination": [
      "obj-318",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-321",
      0
     ],
     "destination": [
      "obj-322",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-322",
      0
     ],
     "destination": [
      "obj-323",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-323",
      0
     ],
     "destination": [
      "obj-319",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-324",
      0
     ],
     "destination": [
      "obj-319",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-319",
      0
     ],
     "destination": [
      "obj-325",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-325",
      0
     ],
     "destination": [
      "obj-326",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-329",
      0
     ],
     "destination": [
      "obj-330",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-330",
      0
     ],
     "destination": [
      "obj-331",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-331",
      0
     ],
     "destination": [
      "obj-327",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-332",
      0
     ],
     "destination": [
      "obj-327",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-327",
      0
     ],
     "destination": [
      "obj-333",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-333",
      0
     ],
     "destination": [
      "obj-334",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-337",
      0
     ],
     "destination": [
      "obj-338",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-338",
      0
     ],
     "destination": [
      "obj-339",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-339",
      0
     ],
     "destination": [
      "obj-335",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-340",
      0
     ],
     "destination": [
      "obj-335",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-335",
      0
     ],
     "destination": [
      "obj-341",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-341",
      0
     ],
     "destination": [
      "obj-342",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-345",
      0
     ],
     "destination": [
      "obj-346",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-346",
      0
     ],
     "destination": [
      "obj-347",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-347",
      0
     ],
     "destination": [
      "obj-343",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-348",
      0
     ],
     "destination": [
      "obj-343",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-343",
      0
     ],
     "destination": [
      "obj-349",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-349",
      0
     ],
     "destination": [
      "obj-350",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-353",
      0
     ],
     "destination": [
      "obj-354",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-354",
      0
     ],
     "destination": [
      "obj-355",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-355",
      0
     ],
     "destination": [
      "obj-351",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-356",
      0
     ],
     "destination": [
      "obj-351",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-351",
      0
     ],
     "destination": [
      "obj-357",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-357",
      0
     ],
     "destination": [
      "obj-358",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-361",
      0
     ],
     "destination": [
      "obj-362",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-362",
      0
     ],
     "destination": [
      "obj-363",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-363",
      0
     ],
     "destination": [
      "obj-359",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-364",
      0
     ],
     "destination": [
      "obj-359",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-359",
      0
     ],
     "destination": [
      "obj-365",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-365",
      0
     ],
     "destination": [
      "obj-366",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-369",
      0
     ],
     "destination": [
      "obj-370",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-370",
      0
     ],
     "destination": [
      "obj-371",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-371",
      0
     ],
     "destination": [
      "obj-367",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-372",
      0
     ],
     "destination": [
      "obj-367",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-367",
      0
     ],
     "destination": [
      "obj-373",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-373",
      0
     ],
     "destination": [
      "obj-374",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-377",
      0
     ],
     "destination": [
      "obj-378",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-378",
      0
     ],
     "destination": [
      "obj-379",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-379",
      0
     ],
     "destination": [
      "obj-375",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-380",
      0
     ],
     "destination": [
      "obj-375",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-375",
      0
     ],
     "destination": [
      "obj-381",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-381",
      0
     ],
     "destination": [
      "obj-382",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-386",
      0
     ],
     "destination": [
      "obj-387",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-387",
      0
     ],
     "destination": [
      "obj-388",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-388",
      0
     ],
     "destination": [
      "obj-384",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-389",
      0
     ],
     "destination": [
      "obj-384",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-384",
      0
     ],
     "destination": [
      "obj-390",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-390",
      0
     ],
     "destination": [
      "obj-391",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-394",
      0
     ],
     "destination": [
      "obj-395",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-395",
      0
     ],
     "destination": [
      "obj-396",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-396",
      0
     ],
     "destination": [
      "obj-392",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-397",
      0
     ],
     "destination": [
      "obj-392",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-392",
      0
     ],
     "destination": [
      "obj-398",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-398",
      0
     ],
     "destination": [
      "obj-399",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-402",
      0
     ],
     "destination": [
      "obj-403",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-403",
      0
     ],
     "destination": [
      "obj-404",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-404",
      0
     ],
     "destination": [
      "obj-400",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-405",
      0
     ],
     "destination": [
      "obj-400",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-400",
      0
     ],
     "destination": [
      "obj-406",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-406",
      0
     ],
     "destination": [
      "obj-407",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-410",
      0
     ],
     "destination": [
      "obj-411",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-411",
      0
     ],
     "destination": [
      "obj-412",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-412",
      0
     ],
     "destination": [
      "obj-408",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-413",
      0
     ],
     "destination": [
      "obj-408",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-408",
      0
     ],
     "destination": [
      "obj-414",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-414",
      0
     ],
     "destination": [
      "obj-415",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-418",
      0
     ],
     "destination": [
      "obj-419",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-419",
      0
     ],
     "destination": [
      "obj-420",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-420",
      0
     ],
     "destination": [
      "obj-416",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-421",
      0
     ],
     "destination": [
      "obj-416",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-416",
      0
     ],
     "destination": [
      "obj-422",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-422",
      0
     ],
     "destination": [
      "obj-423",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-426",
      0
     ],
     "destination": [
      "obj-427",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-427",
      0
     ],
     "destination": [
      "obj-428",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-428",
      0
     ],
     "destination": [
      "obj-424",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-429",
      0
     ],
     "destination": [
      "obj-424",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-424",
      0
     ],
     "destination": [
      "obj-430",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-430",
      0
     ],
     "destination": [
      "obj-431",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-434",
      0
     ],
     "destination": [
      "obj-435",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-435",
      0
     ],
     "destination": [
      "obj-436",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-436",
      0
     ],
     "destination": [
      "obj-432",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-437",
      0
     ],
     "destination": [
      "obj-432",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-432",
      0
     ],
     "destination": [
      "obj-438",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-438",
      0
     ],
     "destination": [
      "obj-439",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-442",
      0
     ],
     "destination": [
      "obj-443",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-443",
      0
     ],
     "destination": [
      "obj-444",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-444",
      0
     ],
     "destination": [
      "obj-440",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-445",
      0
     ],
     "destination": [
      "obj-440",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-440",
      0
     ],
     "destination": [
      "obj-446",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-446",
      0
     ],
     "destination": [
      "obj-447",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-451",
      0
     ],
     "destination": [
      "obj-452",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-452",
      0
     ],
     "destination": [
      "obj-453",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-453",
      0
     ],
     "destination": [
      "obj-449",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-454",
      0
     ],
     "destination": [
      "obj-449",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-449",
      0
     ],
     "destination": [
      "obj-455",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-455",
      0
     ],
     "destination": [
      "obj-456",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-459",
      0
     ],
     "destination": [
      "obj-460",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-460",
      0
     ],
     "destination": [
      "obj-461",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-461",
      0
     ],
     "destination": [
      "obj-457",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-462",
      0
     ],
     "destination": [
      "obj-457",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-457",
      0
     ],
     "destination": [
      "obj-463",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-463",
      0
     ],
     "destination": [
      "obj-464",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-467",
      0
     ],
     "destination": [
      "obj-468",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-468",
      0
     ],
     "destination": [
      "obj-469",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-469",
      0
     ],
     "destination": [
      "obj-465",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-470",
      0
     ],
     "destination": [
      "obj-465",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-465",
      0
     ],
     "destination": [
      "obj-471",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-471",
      0
     ],
     "destination": [
      "obj-472",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-475",
      0
     ],
     "destination": [
      "obj-476",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-476",
      0
     ],
     "destination": [
      "obj-477",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-477",
      0
     ],
     "destination": [
      "obj-473",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-478",
      0
     ],
     "destination": [
      "obj-473",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-473",
      0
     ],
     "destination": [
      "obj-479",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-479",
      0
     ],
     "destination": [
      "obj-480",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-483",
      0
     ],
     "destination": [
      "obj-484",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-484",
      0
     ],
     "destination": [
      "obj-485",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-485",
      0
     ],
     "destination": [
      "obj-481",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-486",
      0
     ],
     "destination": [
      "obj-481",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-481",
      0
     ],
     "destination": [
      "obj-487",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-487",
      0
     ],
     "destination": [
      "obj-488",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-492",
      0
     ],
     "destination": [
      "obj-493",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-493",
      0
     ],
     "destination": [
      "obj-494",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-494",
      0
     ],
     "destination": [
      "obj-490",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-495",
      0
     ],
     "destination": [
      "obj-490",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-490",
      0
     ],
     "destination": [
      "obj-496",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-496",
      0
     ],
     "destination": [
      "obj-497",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-500",
      0
     ],
     "destination": [
      "obj-501",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-501",
      0
     ],
     "destination": [
      "obj-502",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-502",
      0
     ],
     "destination": [
      "obj-498",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-503",
      0
     ],
     "destination": [
      "obj-498",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-498",
      0
     ],
     "destination": [
      "obj-504",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-504",
      0
     ],
     "destination": [
      "obj-505",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-509",
      0
     ],
     "destination": [
      "obj-510",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-510",
      0
     ],
     "destination": [
      "obj-511",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-511",
      0
     ],
     "destination": [
      "obj-507",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-512",
      0
     ],
     "destination": [
      "obj-507",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-507",
      0
     ],
     "destination": [
      "obj-513",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-513",
      0
     ],
     "destination": [
      "obj-514",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-517",
      0
     ],
     "destination": [
      "obj-518",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-518",
      0
     ],
     "destination": [
      "obj-519",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-519",
      0
     ],
     "destination": [
      "obj-515",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-520",
      0
     ],
     "destination": [
      "obj-515",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-515",
      0
     ],
     "destination": [
      "obj-521",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-521",
      0
     ],
     "destination": [
      "obj-522",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-525",
      0
     ],
     "destination": [
      "obj-526",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-526",
      0
     ],
     "destination": [
      "obj-527",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-527",
      0
     ],
     "destination": [
      "obj-523",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-528",
      0
     ],
     "destination": [
      "obj-523",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-523",
      0
     ],
     "destination": [
      "obj-529",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-529",
      0
     ],
     "destination": [
      "obj-530",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-533",
      0
     ],
     "destination": [
      "obj-534",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-534",
      0
     ],
     "destination": [
      "obj-535",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-535",
      0
     ],
     "destination": [
      "obj-531",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-536",
      0
     ],
     "destination": [
      "obj-531",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-531",
      0
     ],
     "destination": [
      "obj-537",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-537",
      0
     ],
     "destination": [
      "obj-538",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-542",
      0
     ],
     "destination": [
      "obj-543",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-543",
      0
     ],
     "destination": [
      "obj-544",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-544",
      0
     ],
     "destination": [
      "obj-540",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-545",
      0
     ],
     "destination": [
      "obj-540",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-540",
      0
     ],
     "destination": [
      "obj-546",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-546",
      0
     ],
     "destination": [
      "obj-547",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-550",
      0
     ],
     "destination": [
      "obj-551",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-551",
      0
     ],
     "destination": [
      "obj-552",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-552",
      0
     ],
     "destination": [
      "obj-548",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-553",
      0
     ],
     "destination": [
      "obj-548",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-548",
      0
     ],
     "destination": [
      "obj-554",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-554",
      0
     ],
     "destination": [
      "obj-555",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-558",
      0
     ],
     "destination": [
      "obj-559",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-559",
      0
     ],
     "destination": [
      "obj-560",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-560",
      0
     ],
     "destination": [
      "obj-556",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-561",
      0
     ],
     "destination": [
      "obj-556",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-556",
      0
     ],
     "destination": [
      "obj-562",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-562",
      0
     ],
     "destination": [
      "obj-563",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-566",
      0
     ],
     "destination": [
      "obj-567",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-567",
      0
     ],
     "destination": [
      "obj-568",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-568",
      0
     ],
     "destination": [
      "obj-564",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-569",
      0
     ],
     "destination": [
      "obj-564",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-564",
      0
     ],
     "destination": [
      "obj-570",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-570",
      0
     ],
     "destination": [
      "obj-571",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-575",
      0
     ],
     "destination": [
      "obj-576",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-576",
      0
     ],
     "destination": [
      "obj-577",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-577",
      0
     ],
     "destination": [
      "obj-573",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-578",
      0
     ],
     "destination": [
      "obj-573",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-573",
      0
     ],
     "destination": [
      "obj-579",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-579",
      0
     ],
     "destination": [
      "obj-580",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-583",
      0
     ],
     "destination": [
      "obj-584",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-584",
      0
     ],
     "destination": [
      "obj-585",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-585",
      0
     ],
     "destination": [
      "obj-581",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-586",
      0
     ],
     "destination": [
      "obj-581",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-581",
      0
     ],
     "destination": [
      "obj-587",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-587",
      0
     ],
     "destination": [
      "obj-588",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-591",
      0
     ],
     "destination": [
      "obj-592",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-592",
      0
     ],
     "destination": [
      "obj-593",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-593",
      0
     ],
     "destination": [
      "obj-589",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-594",
      0
     ],
     "destination": [
      "obj-589",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-589",
      0
     ],
     "destination": [
      "obj-595",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-595",
      0
     ],
     "destination": [
      "obj-596",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-599",
      0
     ],
     "destination": [
      "obj-600",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-600",
      0
     ],
     "destination": [
      "obj-601",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-601",
      0
     ],
     "destination": [
      "obj-597",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-602",
      0
     ],
     "destination": [
      "obj-597",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-597",
      0
     ],
     "destination": [
      "obj-603",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-603",
      0
     ],
     "destination": [
      "obj-604",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-607",
      0
     ],
     "destination": [
      "obj-608",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-608",
      0
     ],
     "destination": [
      "obj-609",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-609",
      0
     ],
     "destination": [
      "obj-605",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-610",
      0
     ],
     "destination": [
      "obj-605",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-605",
      0
     ],
     "destination": [
      "obj-611",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-611",
      0
     ],
     "destination": [
      "obj-612",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-615",
      0
     ],
     "destination": [
      "obj-616",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-616",
      0
     ],
     "destination": [
      "obj-617",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-617",
      0
     ],
     "destination": [
      "obj-613",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-618",
      0
     ],
     "destination": [
      "obj-613",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-613",
      0
     ],
     "destination": [
      "obj-619",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-619",
      0
     ],
     "destination": [
      "obj-620",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-623",
      0
     ],
     "destination": [
      "obj-624",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-624",
      0
     ],
     "destination": [
      "obj-625",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-625",
      0
     ],
     "destination": [
      "obj-621",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-626",
      0
     ],
     "destination": [
      "obj-621",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-621",
      0
     ],
     "destination": [
      "obj-627",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-627",
      0
     ],
     "destination": [
      "obj-628",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-632",
      0
     ],
     "destination": [
      "obj-633",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-633",
      0
     ],
     "destination": [
      "obj-634",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-634",
      0
     ],
     "destination": [
      "obj-630",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-635",
      0
     ],
     "destination": [
      "obj-630",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-630",
      0
     ],
     "destination": [
      "obj-636",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-636",
      0
     ],
     "destination": [
      "obj-637",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-640",
      0
     ],
     "destination": [
      "obj-641",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-641",
      0
     ],
     "destination": [
      "obj-642",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-642",
      0
     ],
     "destination": [
      "obj-638",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-643",
      0
     ],
     "destination": [
      "obj-638",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-638",
      0
     ],
     "destination": [
      "obj-644",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-644",
      0
     ],
     "destination": [
      "obj-645",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-648",
      0
     ],
     "destination": [
      "obj-649",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-649",
      0
     ],
     "destination": [
      "obj-650",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-650",
      0
     ],
     "destination": [
      "obj-646",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-651",
      0
     ],
     "destination": [
      "obj-646",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-646",
      0
     ],
     "destination": [
      "obj-652",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-652",
      0
     ],
     "destination": [
      "obj-653",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-656",
      0
     ],
     "destination": [
      "obj-657",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-657",
      0
     ],
     "destination": [
      "obj-658",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-658",
      0
     ],
     "destination": [
      "obj-654",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-659",
      0
     ],
     "destination": [
      "obj-654",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-654",
      0
     ],
     "destination": [
      "obj-660",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-660",
      0
     ],
     "destination": [
      "obj-661",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-664",
      0
     ],
     "destination": [
      "obj-665",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-665",
      0
     ],
     "destination": [
      "obj-666",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-666",
      0
     ],
     "destination": [
      "obj-662",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-667",
      0
     ],
     "destination": [
      "obj-662",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-662",
      0
     ],
     "destination": [
      "obj-668",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-668",
      0
     ],
     "destination": [
      "obj-669",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-672",
      0
     ],
     "destination": [
      "obj-673",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-673",
      0
     ],
     "destination": [
      "obj-674",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-674",
      0
     ],
     "destination": [
      "obj-670",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-675",
      0
     ],
     "destination": [
      "obj-670",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-670",
      0
     ],
     "destination": [
      "obj-676",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-676",
      0
     ],
     "destination": [
      "obj-677",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-681",
      0
     ],
     "destination": [
      "obj-682",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-682",
      0
     ],
     "destination": [
      "obj-683",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-683",
      0
     ],
     "destination": [
      "obj-679",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-684",
      0
     ],
     "destination": [
      "obj-679",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-679",
      0
     ],
     "destination": [
      "obj-685",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-685",
      0
     ],
     "destination": [
      "obj-686",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-689",
      0
     ],
     "destination": [
      "obj-690",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-690",
      0
     ],
     "destination": [
      "obj-691",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-691",
      0
     ],
     "destination": [
      "obj-687",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-692",
      0
     ],
     "destination": [
      "obj-687",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-687",
      0
     ],
     "destination": [
      "obj-693",
      0
     ],
     "order": 0
    }
   },
   {
    "patchline": {
     "source": [
      "obj-693",
      0
     ],
     "destination": [
      "obj-694",
      0
     ],
     "order": 0
    }
   }
  ],
  "dependency_cache": [],
  "autosave": 0
 }
}
