// For files that have both stages of a pass, of which PSYGEN_VERT or PSYGEN_FRAG is compiled: PASSED
// is what the vertex shader writes and the fragment shader reads.
#ifdef PSYGEN_VERT
#define PASSED out
#else
#define PASSED in
#endif
