-- Makes a session of Ardour whose only track has the plug-in:
--
--     ardour7-lua ardour_session.lua FOLDER NAME FORMAT IDENTITY
local folder, name, format, identity = table.unpack(arg)

AudioEngine:set_backend("None (Dummy)", "", "")
local session = create_session(folder, name, 48000)
local midi, audio = ARDOUR.DataType("midi"), ARDOUR.DataType("audio")
local tracks = session:new_midi_track(
  ARDOUR.ChanCount(midi, 1), ARDOUR.ChanCount(audio, 2), true, ARDOUR.PluginInfo(), nil, nil, 1,
  "Yehu", ARDOUR.PresentationInfo.max_order, ARDOUR.TrackMode.Normal, true)
for track in tracks:iter() do
  local plugin = ARDOUR.LuaAPI.new_plugin(session, identity, ARDOUR.PluginType[format], "")
  assert(not plugin:isnil(), "no such plug-in")
  assert(track:add_processor_by_index(plugin, 0, nil, true) == 0)
  for side = 0, 1 do
    track:output():audio(side):connect("Master/audio_in " .. side + 1)
  end
end
session:save_state("", false, false, false, false, false)
close_session()
