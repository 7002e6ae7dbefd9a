#include "engine/inspect/line_server.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "engine/inspect/client.hpp"
#include "tests/temporary_folder.hpp"

namespace psygen::inspect {
namespace {

class LineServerTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
    auto server = LineServer::open(folder_.path());
    ASSERT_TRUE(server) << server.error().message;
    server_ = std::move(*server);
  }
  void send(const Descriptor& fd, std::string_view bytes) {
    ASSERT_EQ(::send(fd.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }
  TemporaryFolder folder_;
  std::unique_ptr<LineServer> server_;
};

TEST_F(LineServerTest, HasASocketThatOnlyThisUserCanOpenAndRemovesIt) {
  struct stat is {};
  const std::filesystem::path socket = server_->address();
  ASSERT_EQ(::lstat(socket.c_str(), &is), 0);
  EXPECT_TRUE(S_ISSOCK(is.st_mode));
  EXPECT_EQ(is.st_mode & 0777, 0600U);
  server_.reset();
  EXPECT_FALSE(std::filesystem::exists(socket));
}

TEST_F(LineServerTest, RejectsFoldersThatOthersMayEnter) {
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0750), 0);
  EXPECT_EQ(LineServer::open(folder_.path()).error().code, core::ErrorCode::kInvalidArgument);
  EXPECT_EQ(endpoints(folder_.path()).error().code, core::ErrorCode::kInvalidArgument);
  ASSERT_EQ(::chmod(folder_.path().c_str(), 0700), 0);
  std::filesystem::create_directory_symlink(folder_.path(), folder_.path() / "link");
  EXPECT_FALSE(LineServer::open(folder_.path() / "link"));
  std::ofstream(folder_.path() / "file") << "x";
  EXPECT_FALSE(LineServer::open(folder_.path() / "file"));
  EXPECT_FALSE(LineServer::open(folder_.path() / "nothing"));
}

TEST_F(LineServerTest, RejectsAFolderWithANameTooLongForASocket) {
  const auto deep = folder_.path() / std::string(100, 'd');
  std::filesystem::create_directory(deep);
  ASSERT_EQ(::chmod(deep.c_str(), 0700), 0);
  EXPECT_EQ(LineServer::open(deep).error().code, core::ErrorCode::kInvalidArgument);
}

TEST_F(LineServerTest, RemovesOnlyTheSocketsOfCrashedPrograms) {
  const auto dead = folder_.path() / "psygen-1.inspect", file = folder_.path() / "psygen-2.inspect";
  {
    const Descriptor fd(::socket(AF_UNIX, SOCK_STREAM, 0));
    const auto address = address_of(dead);
    ASSERT_EQ(::bind(fd.get(), reinterpret_cast<const sockaddr*>(&*address), sizeof(*address)), 0);
  }
  std::ofstream(file) << "not a socket";
  const auto other = LineServer::open(folder_.path());
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_NE((*other)->address(), server_->address());
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_TRUE(std::filesystem::exists(file));
  EXPECT_TRUE(std::filesystem::exists(server_->address()));
  EXPECT_EQ(endpoints(folder_.path())->size(), 2U);
}

TEST_F(LineServerTest, JoinsPartialLines) {
  EXPECT_FALSE(server_->accept());
  const Descriptor client = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  for (const char c : std::string_view("one\ntwo\nthr")) {
    send(client, {&c, 1});
    server_->receive();
  }
  EXPECT_EQ(server_->take_line(), "one");
  server_->receive();
  EXPECT_EQ(server_->take_line(), "two");
  EXPECT_EQ(server_->take_line(), std::nullopt);
  send(client, "ee\n");
  server_->receive();
  EXPECT_EQ(server_->take_line(), "three");
}

TEST_F(LineServerTest, ClosesTheConnectionAtALineWithoutEnd) {
  const Descriptor client = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  const std::string much(1 << 16, 'x');
  std::size_t sent = 0;
  for (int frame = 0; frame < 10'000 && server_->attached(); ++frame) {
    const ssize_t went = ::send(client.get(), much.data(), much.size(), MSG_NOSIGNAL);
    sent += went > 0 ? static_cast<std::size_t>(went) : 0;
    server_->receive();
    EXPECT_EQ(server_->take_line(), std::nullopt);
  }
  EXPECT_FALSE(server_->attached());
  EXPECT_LT(sent, 2 * kMaxLineBytes);
}

TEST_F(LineServerTest, AcceptsNoMoreLinesFromAClientThatDoesNotRead) {
  const Descriptor client = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  const std::string answer(100'000, 'a');
  std::size_t answers = 0, asked = 0;
  for (int frame = 0; frame < 2000; ++frame) {
    asked += ::send(client.get(), "q\n", 2, MSG_NOSIGNAL) == 2 ? 1 : 0;
    server_->receive();
    while (server_->take_line()) {
      server_->send(answer);
      ++answers;
    }
    server_->transmit();
  }
  EXPECT_LT(answers, 40U);
  EXPECT_GT(asked, answers);
  EXPECT_TRUE(server_->attached());
}

TEST_F(LineServerTest, RejectsASecondClientWithAMessage) {
  const Descriptor first = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  const auto second = Client::attach(server_->address());
  ASSERT_TRUE(second);
  server_->receive();
  EXPECT_THAT((*second)->take_answer().value_or(""), ::testing::HasSubstr("already attached"));
  EXPECT_EQ((*second)->take_answer(), std::nullopt);
  EXPECT_FALSE((*second)->is_open());
  EXPECT_TRUE(server_->attached());
}

TEST_F(LineServerTest, AProgramThatLooksForSessionsTakesNoSeat) {
  const auto found = endpoints(folder_.path());
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(found->front().pid, ::getpid());
  EXPECT_EQ(found->front().socket, server_->address());
  EXPECT_FALSE(server_->accept()) << "nobody has connected";
  { const Descriptor look = connect_to(server_->address()); }  // another kind of look
  const Descriptor client = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  send(client, "hello\n");
  server_->receive();
  EXPECT_EQ(server_->take_line(), "hello") << "in the same frame";
}

TEST_F(LineServerTest, DetectsThatAClientIsGoneAndAcceptsTheNext) {
  {
    const Descriptor client = connect_to(server_->address());
    ASSERT_TRUE(server_->accept());
    send(client, "half a li");
  }
  server_->send("for nobody");
  server_->transmit();
  server_->receive();
  EXPECT_FALSE(server_->attached());
  const Descriptor next = connect_to(server_->address());
  ASSERT_TRUE(server_->accept());
  server_->receive();
  EXPECT_EQ(server_->take_line(), std::nullopt);
}

}  // namespace
}  // namespace psygen::inspect
