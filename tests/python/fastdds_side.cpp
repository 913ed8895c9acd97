/// \file fastdds_side.cpp  A stereo camera and a listener of odometry, with Fast DDS and types made from ROS's
/// messages.
///
///   fastdds_side DOMAIN FRAMES     FRAMES: width, height, count (int32), fx, cx, cy, baseline (double), then of every
///                                  frame the stamp [ns] (int64) and both images
///
/// Prints a line per message that it reads, numbers in full: odometry, tf, diagnostics, edges.

#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fstream>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "MessagesPubSubTypes.h"

using namespace eprosima::fastdds::dds;
namespace sensor = sensor_msgs::msg::dds_;

template <class T>
T read(std::ifstream& file) {
  T value{};
  file.read(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

DomainParticipant* join(int domain) {
  auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.emplace_back("127.0.0.1");
  DomainParticipantQos qos;
  qos.transport().use_builtin_transports = false;
  qos.transport().user_transports.push_back(transport);
  return DomainParticipantFactory::get_instance()->create_participant(static_cast<DomainId_t>(domain), qos);
}

template <class Type>
Topic* topic(DomainParticipant* participant, const char* name) {
  TypeSupport type(new Type);
  type.register_type(participant);
  return participant->create_topic(name, type.get_type_name(), TOPIC_QOS_DEFAULT);
}

/// As image_transport of ROS: best effort.
template <class Type>
DataWriter* writer(DomainParticipant* participant, const char* name) {
  DataWriterQos qos;
  qos.reliability().kind = BEST_EFFORT_RELIABILITY_QOS;
  qos.history().depth = 5;
  return participant->create_publisher(PUBLISHER_QOS_DEFAULT)->create_datawriter(topic<Type>(participant, name), qos);
}

template <class Type>
class Printer : public DataReaderListener {
 public:
  using Message = typename Type::type;
  Printer(DomainParticipant* participant, const char* name, std::function<void(Message&)> print)
      : print_(std::move(print)) {
    DataReaderQos qos;
    qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 100;
    reader_ = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
                  ->create_datareader(topic<Type>(participant, name), qos, this);
  }
  void on_data_available(DataReader* reader) override {
    Message message;
    SampleInfo info;
    while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
      if (info.valid_data) print_(message);
  }

 private:
  std::function<void(Message&)> print_;
  DataReader* reader_;
};

long long nanoseconds(const builtin_interfaces::msg::dds_::Time_& stamp) {
  return stamp.sec() * 1000000000LL + stamp.nanosec();
}

template <class Values>
void print_all(const Values& values) {
  for (const double value : values) std::printf(" %a", value);
}

void print_odometry(nav_msgs::msg::dds_::Odometry_& message) {
  const auto& pose = message.pose().pose();
  std::printf("odometry %lld %s %s %a %a %a %a %a %a %a", nanoseconds(message.header().stamp()),
              message.header().frame_id().c_str(), message.child_frame_id().c_str(), pose.position().x(),
              pose.position().y(), pose.position().z(), pose.orientation().x(), pose.orientation().y(),
              pose.orientation().z(), pose.orientation().w());
  print_all(message.pose().covariance());
  std::printf(" %a", message.twist().twist().linear().x());
  print_all(message.twist().covariance());
  std::printf("\n");
}

int main(int, char** arguments) {
  DomainParticipant* participant = join(std::stoi(arguments[1]));
  const Printer<nav_msgs::msg::dds_::Odometry_PubSubType> odometry(participant, "rt/quadedge/odometry", print_odometry);
  const Printer<tf2_msgs::msg::dds_::TFMessage_PubSubType> tf(participant, "rt/tf", [](auto& message) {
    for (const auto& one : message.transforms())
      std::printf("tf %lld %s %s %a\n", nanoseconds(one.header().stamp()), one.header().frame_id().c_str(),
                  one.child_frame_id().c_str(), one.transform().translation().x());
  });
  const Printer<diagnostic_msgs::msg::dds_::DiagnosticArray_PubSubType> diagnostics(
      participant, "rt/diagnostics", [](auto& message) {
        std::printf("diagnostics %d %s", message.status()[0].level(), message.status()[0].message().c_str());
        for (const auto& pair : message.status()[0].values())
          std::printf(" | %s = %s", pair.key().c_str(), pair.value().c_str());
        std::printf("\n");
      });
  const Printer<sensor::PointCloud2_PubSubType> edges(participant, "rt/quadedge/edges", [](auto& message) {
    std::printf("edges %lld %u %u %zu %s\n", nanoseconds(message.header().stamp()), message.width(),
                message.point_step(), message.data().size(), message.fields()[2].name().c_str());
  });

  std::ifstream file(arguments[2], std::ios::binary);
  const auto width = read<std::int32_t>(file), height = read<std::int32_t>(file), count = read<std::int32_t>(file);
  const auto fx = read<double>(file), cx = read<double>(file), cy = read<double>(file), baseline = read<double>(file);
  const char* names[][2] = {{"rt/cam/left/image_rect", "rt/cam/left/camera_info"},
                            {"rt/cam/right/image_rect", "rt/cam/right/camera_info"}};
  DataWriter *images[2], *infos[2];
  for (int side = 0; side < 2; ++side) {
    images[side] = writer<sensor::Image_PubSubType>(participant, names[side][0]);
    infos[side] = writer<sensor::CameraInfo_PubSubType>(participant, names[side][1]);
  }
  const auto matched = [&](DataWriter* one) {
    PublicationMatchedStatus status;
    one->get_publication_matched_status(status);
    return status.current_count > 0;
  };
  for (int i = 0; i < 600 && !(matched(images[0]) && matched(images[1]) && matched(infos[0]) && matched(infos[1])); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  for (int i = 0; i < count; ++i) {
    const auto stamp = read<std::int64_t>(file);
    for (int side = 0; side < 2; ++side) {
      sensor::Image_ image;
      image.header().stamp().sec(static_cast<std::int32_t>(stamp / 1000000000));
      image.header().stamp().nanosec(static_cast<std::uint32_t>(stamp % 1000000000));
      image.header().frame_id("optical");
      image.height(height);
      image.width(width);
      image.step(width);
      image.encoding("mono8");
      image.data().resize(static_cast<std::size_t>(width) * height);
      file.read(reinterpret_cast<char*>(image.data().data()), static_cast<std::streamsize>(image.data().size()));
      sensor::CameraInfo_ info;
      info.header() = image.header();
      info.height(height);
      info.width(width);
      info.distortion_model("plumb_bob");
      info.d(std::vector<double>(5, 0.0));
      info.k({fx, 0, cx, 0, fx, cy, 0, 0, 1});
      info.r({1, 0, 0, 0, 1, 0, 0, 0, 1});
      info.p({fx, 0, cx, side == 0 ? 0 : -fx * baseline, 0, fx, cy, 0, 0, 0, 1, 0});
      infos[side]->write(&info);
      images[side]->write(&image);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
  std::fflush(stdout);
  std::_Exit(0);
}
