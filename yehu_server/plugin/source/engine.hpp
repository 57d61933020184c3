/* The instrument as it was compiled, in the version that suits the processor at hand. */
#ifndef YEHU_ENGINE_HPP
#define YEHU_ENGINE_HPP

#include "yehu.h"

namespace yehu {

struct Engine {
    decltype(&yehu_size) size;
    decltype(&yehu_prepare) prepare;
    decltype(&yehu_reset) reset;
    decltype(&yehu_post) post;
    decltype(&yehu_midi) midi;
    decltype(&yehu_use_tables) use_tables;
    decltype(&yehu_process) process;
    decltype(&yehu_frame) frame;
    decltype(&yehu_value) value;
    decltype(&yehu_pitch) pitch;
    decltype(&yehu_snapshot) snapshot;
};

const Engine &engine();

} /* namespace yehu */

#endif
