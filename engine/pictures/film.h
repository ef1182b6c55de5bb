// Draws frames of a trajectory as the pictures of a film: `peclet-engine snapshot --frames`.
#pragma once

#include <string>

#include "engine/pictures/picture.h"

namespace peclet::engine {

// Draws the frames that `options.frames` names by chosen_frames(), all with one camera, which sees the
// cells of all frames, and one scale of colours, from the lowest to the highest end of the scales of frames.
// Writes film-00000.png, film-00001.png ... if the output is film.png, and then has ffmpeg make
// film.mp4 of them, with 25 frames per second. Returns a note for the user: the command that makes the film,
// if there is no ffmpeg. All frames are read before the first picture is written. Throws InputError or
// std::system_error, and std::runtime_error if ffmpeg fails. Requires `options.frames`.
std::string draw_film(const PictureOptions& options);

}  // namespace peclet::engine
