#pragma once

#include <stddef.h>

/// The static models for other languages: a robot held in memory, tables of numbers in and out.
/// libmujoco_continuum_statics.so exports these five functions and nothing else. A robot may be
/// used by one thread at a time; rows are solved on all cores.
#ifdef __cplusplus
extern "C" {
#endif

#define CONTINUUM_EXPORT __attribute__((visibility("default")))

typedef struct ContinuumStatics ContinuumStatics;

/// robot: its YAML file. method: as --method, or "". inverse: stiff_flop takes shapes and gives
/// pressures. Returns NULL and writes a message of less than `size` bytes to `error` for bad input.
CONTINUUM_EXPORT ContinuumStatics* continuum_statics_open(const char* robot, const char* method,
                                                          int inverse, char* error, size_t size);
CONTINUUM_EXPORT void continuum_statics_close(ContinuumStatics*);

/// Names of the results' columns, joined by commas. The first is `ok`.
CONTINUUM_EXPORT const char* continuum_statics_columns(const ContinuumStatics*);

/// header: names of the columns of `values` (rows x columns, row after row) joined by commas, then
/// those that are the same in all rows; constants: these cells, each with a comma before it. SI
/// units. results: rows x (number of result columns), NaN where a case has no answer. Returns 0, or
/// 2 for bad input and 1 for any other failure, with a message.
CONTINUUM_EXPORT int continuum_statics_solve(ContinuumStatics*, const char* header,
                                             const char* constants, const double* values,
                                             size_t rows, size_t columns, double* results,
                                             char* error, size_t size);

/// Why a row of the last call has no answer; "" where it has one. Valid until the next call.
CONTINUUM_EXPORT const char* continuum_statics_why(const ContinuumStatics*, size_t row);

#ifdef __cplusplus
}
#endif
