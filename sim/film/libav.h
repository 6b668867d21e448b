#pragma once

#include <functional>
#include <memory>
#include <string>

struct AVCodecContext;
struct AVFrame;
struct AVPacket;

namespace continuum {

/// Owners and return codes of libav, for films.
namespace av {

struct Deleter {
  void operator()(AVCodecContext* codec) const;
  void operator()(AVFrame* frame) const;
  void operator()(AVPacket* packet) const;
};
template <class T>
using Owned = std::unique_ptr<T, Deleter>;

/// code, unless it is negative: then throws Error (kJob) with libav's own text.
int Check(int code, const std::string& what);

/// As Check, for what writes a file: throws Error (kInput) with the bare reason where the file, not
/// libav, is to blame (full, too large, gone).
int CheckWritten(int code, const std::string& what);

/// libav's text for a negative return code.
std::string Reason(int code);

/// An encoder by name. Throws Error (kJob) when libav was built without it.
Owned<AVCodecContext> NewEncoder(const char* name);

/// A frame with buffers in the size and pixel format of an encoder.
Owned<AVFrame> NewFrame(const AVCodecContext& encoder);

/// Gives an encoder one frame (null: the end) and hands on every packet that is then ready.
void Encode(AVCodecContext& encoder, const AVFrame* frame,
            const std::function<void(AVPacket&)>& take);

}  // namespace av
}  // namespace continuum
