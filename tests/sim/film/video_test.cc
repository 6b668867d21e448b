#include "sim/film/video.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "error.h"
#include "sim/film/image.h"
#include "sim/io/file.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libswscale/swscale.h>
}

namespace continuum {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

fs::path Folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const fs::path folder = fs::path(::testing::TempDir()) / "continuum_video" / test->name();
  fs::remove_all(folder);
  fs::create_directories(folder);
  return folder;
}

std::vector<std::string> Files(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

Image Flat(int width, int height, int level) {
  const auto count = 3 * static_cast<std::size_t>(width) * height;
  return {width, height, std::vector<unsigned char>(count, static_cast<unsigned char>(level))};
}

// Every pixel differs from its neighbours and from its mirror images.
Image Pattern(int width, int height) {
  Image image = Flat(width, height, 0);
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = static_cast<unsigned char>((i * 7 + i / 101) % 256);
  }
  return image;
}

// What libav reads from a film or picture.
struct Media {
  std::string codec;
  unsigned streams = 0;
  double fps = 0, start = 0, duration = 0;  // [1/s], [s], [s]
  AVColorSpace colors = AVCOL_SPC_UNSPECIFIED;
  std::vector<double> time;  // [s]
  std::vector<Image> frames;
};

Image ToRgb(const AVFrame& frame) {
  Image image = Flat(frame.width, frame.height, 0);
  SwsContext* const scaler = sws_getContext(
      frame.width, frame.height, static_cast<AVPixelFormat>(frame.format), frame.width,
      frame.height, AV_PIX_FMT_RGB24, SWS_POINT, nullptr, nullptr, nullptr);
  const int* const bt709 = sws_getCoefficients(SWS_CS_ITU709);
  sws_setColorspaceDetails(scaler, bt709, 0, bt709, 1, 0, 1 << 16, 1 << 16);
  std::uint8_t* const rows[] = {image.rgb.data()};
  const int stride[] = {3 * frame.width};
  sws_scale(scaler, frame.data, frame.linesize, 0, frame.height, rows, stride);
  sws_freeContext(scaler);
  return image;
}

Media Read(const fs::path& path) {
  AVFormatContext* file = nullptr;
  if (avformat_open_input(&file, path.c_str(), nullptr, nullptr) < 0) return {};
  avformat_find_stream_info(file, nullptr);
  const AVStream* const stream = file->streams[0];
  const AVCodec* const codec = avcodec_find_decoder(stream->codecpar->codec_id);
  AVCodecContext* decoder = avcodec_alloc_context3(codec);
  avcodec_parameters_to_context(decoder, stream->codecpar);
  EXPECT_EQ(avcodec_open2(decoder, codec, nullptr), 0);

  Media media{codec->name,
              file->nb_streams,
              av_q2d(stream->avg_frame_rate),
              0,
              0,
              stream->codecpar->color_space,
              {},
              {}};
  media.start = static_cast<double>(stream->start_time) * av_q2d(stream->time_base);
  media.duration = static_cast<double>(stream->duration) * av_q2d(stream->time_base);
  AVPacket* packet = av_packet_alloc();
  AVFrame* frame = av_frame_alloc();
  bool more = true;
  while (more) {
    more = av_read_frame(file, packet) >= 0;
    avcodec_send_packet(decoder, more ? packet : nullptr);
    av_packet_unref(packet);
    while (avcodec_receive_frame(decoder, frame) >= 0) {
      media.time.push_back(static_cast<double>(frame->pts) * av_q2d(stream->time_base));
      media.frames.push_back(ToRgb(*frame));
    }
  }
  av_frame_free(&frame);
  av_packet_free(&packet);
  avcodec_free_context(&decoder);
  avformat_close_input(&file);
  return media;
}

// A film of flat frames, each a little brighter.
void WriteRamp(const fs::path& path, int frames, int fps) {
  VideoWriter writer(path, 64, 48, fps);
  for (int k = 0; k < frames; ++k) writer.Add(Flat(64, 48, 40 + 5 * k));
  writer.Finish();
}

TEST(Png, KeepsEveryPixelAndTheOrderOfTheRows) {
  const fs::path path = Folder() / "picture.png";
  const Image image = Pattern(101, 57);
  WritePng(path, image);
  const Media read = Read(path);
  ASSERT_EQ(read.frames.size(), 1u);
  EXPECT_EQ(read.codec, "png");
  EXPECT_EQ(read.frames[0].width, 101);
  EXPECT_EQ(read.frames[0].height, 57);
  EXPECT_EQ(read.frames[0].rgb, image.rgb);
  EXPECT_THAT(Files(path.parent_path()), ElementsAre("picture.png"));
}

TEST(Png, NamesThePathThatCannotBeWritten) {
  const fs::path path = Folder() / "absent" / "picture.png";
  EXPECT_THAT([&] { WritePng(path, Flat(16, 16, 0)); },
              ThrowsMessage<Error>(AllOf(HasSubstr(path.string()), HasSubstr("No such file"))));
}

TEST(Video, HasEveryFrameAtItsExactTime) {
  for (const int fps : {1, 24, 30, 50, 60, 1000}) {
    const fs::path path = Folder() / "film.mp4";
    WriteRamp(path, 31, fps);
    const Media film = Read(path);
    EXPECT_EQ(film.codec, "h264");
    EXPECT_EQ(film.streams, 1u);
    EXPECT_EQ(film.colors, AVCOL_SPC_BT709);
    EXPECT_DOUBLE_EQ(film.fps, fps);
    EXPECT_EQ(film.start, 0);
    EXPECT_DOUBLE_EQ(film.duration, 31.0 / fps);
    ASSERT_EQ(film.frames.size(), 31u) << fps;
    for (int k = 0; k < 31; ++k) {
      EXPECT_DOUBLE_EQ(film.time[k], static_cast<double>(k) / fps);
      EXPECT_EQ(film.frames[k].width, 64);
      EXPECT_EQ(film.frames[k].height, 48);
      // Limited range has 219 levels for 256: half a step each way, and a step of quantisation.
      EXPECT_NEAR(film.frames[k].rgb[3 * 1000], 40 + 5 * k, 2) << k;
    }
  }
}

TEST(Video, KeepsColoursAndTheOrderOfTheRows) {
  const fs::path path = Folder() / "film.mp4";
  Image image = Flat(64, 48, 0);
  const unsigned char top[] = {200, 60, 40}, bottom[] = {30, 90, 210};
  for (std::size_t i = 0; i < image.rgb.size(); ++i) {
    image.rgb[i] = i < image.rgb.size() / 2 ? top[i % 3] : bottom[i % 3];
  }
  VideoWriter writer(path, 64, 48, 30);
  writer.Add(image);
  writer.Finish();
  const Media film = Read(path);
  ASSERT_EQ(film.frames.size(), 1u);
  const auto& rgb = film.frames[0].rgb;
  for (int c = 0; c < 3; ++c) {
    // 8-bit limited-range chroma: up to half of 256/224 times 1.86, and as much luma, each way.
    EXPECT_NEAR(rgb[3 * (10 * 64 + 32) + c], top[c], 4);
    EXPECT_NEAR(rgb[3 * (40 * 64 + 32) + c], bottom[c], 4);
  }
}

TEST(Video, HasItsIndexInFront) {
  const fs::path path = Folder() / "film.mp4";
  WriteRamp(path, 5, 30);
  const std::string bytes = ReadFile(path);
  ASSERT_NE(bytes.find("moov"), std::string::npos);
  EXPECT_LT(bytes.find("moov"), bytes.find("mdat"));
}

TEST(Video, WritesNothingToStandardError) {
  const fs::path path = Folder() / "film.mp4";
  ::testing::internal::CaptureStderr();
  WriteRamp(path, 5, 30);
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

TEST(Video, LeavesNothingBehindWithoutFinish) {
  const fs::path folder = Folder();
  {
    VideoWriter writer(folder / "film.mp4", 64, 48, 30);
    for (int k = 0; k < 20; ++k) writer.Add(Flat(64, 48, k));
    EXPECT_FALSE(fs::exists(folder / "film.mp4"));
  }
  EXPECT_THAT(Files(folder), IsEmpty());
}

TEST(Video, ReplacesAnOlderFileOnlyWhenFinished) {
  const fs::path path = Folder() / "film.mp4";
  WriteFile(path, "old");
  {
    VideoWriter unfinished(path, 64, 48, 30);
    unfinished.Add(Flat(64, 48, 9));
  }
  EXPECT_EQ(ReadFile(path), "old");
  WriteRamp(path, 3, 30);
  EXPECT_EQ(Read(path).frames.size(), 3u);
  EXPECT_THAT(Files(path.parent_path()), ElementsAre("film.mp4"));
}

TEST(Video, NamesTheSizesThatAreAllowed) {
  const fs::path folder = Folder();
  const auto wanted = [](const char* found) {
    return ThrowsMessage<Error>(
        AllOf(HasSubstr("even width and height from 16 to 8192"), HasSubstr(found)));
  };
  EXPECT_THAT([&] { VideoWriter(folder / "a.mp4", 641, 480, 30); }, wanted("641 x 480"));
  EXPECT_THAT([&] { VideoWriter(folder / "a.mp4", 640, 479, 30); }, wanted("640 x 479"));
  EXPECT_THAT([&] { VideoWriter(folder / "a.mp4", 640, 0, 30); }, wanted("640 x 0"));
  EXPECT_THAT(Files(folder), IsEmpty());
}

TEST(Video, WritesTheSmallestAllowedSize) {
  const fs::path path = Folder() / "film.mp4";
  VideoWriter writer(path, 16, 16, 30);
  for (int k = 0; k < 3; ++k) writer.Add(Pattern(16, 16));
  writer.Finish();
  EXPECT_EQ(Read(path).frames.size(), 3u);
}

TEST(Video, RefusesAFrameOfAnotherSize) {
  VideoWriter writer(Folder() / "film.mp4", 64, 48, 30);
  EXPECT_THAT([&] { writer.Add(Flat(48, 64, 0)); },
              ThrowsMessage<Error>(AllOf(HasSubstr("64 x 48"), HasSubstr("48 x 64"))));
}

TEST(Video, RefusesAnythingAfterItsEnd) {
  VideoWriter writer(Folder() / "film.mp4", 64, 48, 30);
  writer.Add(Flat(64, 48, 0));
  writer.Finish();
  EXPECT_THROW(writer.Add(Flat(64, 48, 0)), Error);
  EXPECT_THROW(writer.Finish(), Error);
}

TEST(Video, WithoutAFrameIsAnErrorAndNoFile) {
  const fs::path folder = Folder();
  EXPECT_THAT([&] { VideoWriter(folder / "film.mp4", 64, 48, 30).Finish(); },
              ThrowsMessage<Error>(HasSubstr("at least one frame")));
  EXPECT_THAT(Files(folder), IsEmpty());
}

TEST(Video, NamesThePathThatCannotBeWritten) {
  const fs::path folder = Folder();
  const fs::path absent = folder / "absent" / "film.mp4";
  EXPECT_THAT([&] { VideoWriter(absent, 64, 48, 30); },
              ThrowsMessage<Error>(AllOf(HasSubstr(absent.string()), HasSubstr("No such file"))));
  fs::create_directory(folder / "film.mp4");
  EXPECT_THAT([&] { VideoWriter(folder / "film.mp4", 64, 48, 30); },
              ThrowsMessage<Error>(HasSubstr("a folder")));
}

TEST(Video, NamesTheFormatAndTheFrameRatesThatAreAllowed) {
  const fs::path folder = Folder();
  EXPECT_THAT([&] { VideoWriter(folder / "film.avi", 64, 48, 30); },
              ThrowsMessage<Error>(HasSubstr("ends in .mp4")));
  EXPECT_THAT([&] { VideoWriter(folder / "film.mp4", 64, 48, 0); },
              ThrowsMessage<Error>(HasSubstr("1 to 1000 frames per second")));
}

// A program that the environment names takes the place of libav, for as long as this lives.
class Program {
 public:
  explicit Program(const fs::path& program) { setenv("CONTINUUM_FFMPEG", program.c_str(), 1); }
  ~Program() { unsetenv("CONTINUUM_FFMPEG"); }
};

TEST(Video, IsEncodedByTheProgramThatTheEnvironmentNames) {
  const fs::path folder = Folder();
  WriteFile(folder / "encoder", "#!/bin/sh\nfor file; do :; done\nwc -c > \"$file\"\n");
  fs::permissions(folder / "encoder", fs::perms::owner_all);
  const Program program(folder / "encoder");
  VideoWriter video(folder / "film.mp4", 16, 32, 30);
  for (int k = 0; k < 3; ++k) video.Add(Flat(16, 32, k));
  video.Finish();
  EXPECT_EQ(ReadFile(folder / "film.mp4"), std::to_string(3 * 3 * 16 * 32) + "\n");
}

TEST(Video, NamesTheProgramThatIsMissingOrFails) {
  const fs::path folder = Folder();
  const auto write = [&] {
    VideoWriter video(folder / "film.mp4", 16, 32, 30);
    video.Add(Flat(16, 32, 1));
    video.Finish();
  };
  {
    const Program program(folder / "none");
    EXPECT_THAT(write,
                ThrowsMessage<Error>(AllOf(HasSubstr("film.mp4: films need the program ffmpeg"),
                                           HasSubstr("pip install imageio-ffmpeg"))));
  }
  const Program program("/bin/false");
  EXPECT_THAT(write, ThrowsMessage<Error>(HasSubstr("/bin/false could not write the film")));
  EXPECT_THAT(Files(folder), IsEmpty());
}

}  // namespace
}  // namespace continuum
