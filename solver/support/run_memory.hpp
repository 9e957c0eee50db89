#pragma once
// The memory that a run takes, in one place: `talus validate` prints it and talusd derives its limit from it.

namespace talus {

/// Arrays of the particles, neighbour lists, copies for output. Measured: 503 bytes per soil particle, 350 per wall
/// particle, which is counted like soil.
inline constexpr double bytes_per_particle = 500.0;
/// Program and libraries.
inline constexpr double bytes_of_program = 18e6;

/// [bytes]
constexpr double run_memory(double particles) { return bytes_of_program + bytes_per_particle * particles; }

}  // namespace talus
