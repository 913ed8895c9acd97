/// \file fastdds_side.cpp  A stereo camera and a listener of odometry, with Fast DDS and types made from ROS's
/// messages.
///
///   fastdds_side DOMAIN FRAMES     FRAMES: width, height, count (int32), fx, cx, cy, baseline (double), then of every
///                                  frame the stamp [ns] (int64) and both images
///
/// Prints a line per message that it reads, numbers in full: odometry, tf, diagnostics, edges. Afterwards it calls the
/// services, and prints a line per reply.

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

std::atomic<int> poses{0};  // that have come

void print_odometry(nav_msgs::msg::dds_::Odometry_& message) {
  ++poses;
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

/// What the file says of both cameras.
struct Rig {
  std::int32_t width, height, count;
  double fx, cx, cy, baseline;
};

sensor::Image_ image_of(const Rig& rig, std::int64_t stamp, std::ifstream& file) {
  sensor::Image_ image;
  image.header().stamp().sec(static_cast<std::int32_t>(stamp / 1000000000));
  image.header().stamp().nanosec(static_cast<std::uint32_t>(stamp % 1000000000));
  image.header().frame_id("optical");
  image.height(rig.height);
  image.width(rig.width);
  image.step(rig.width);
  image.encoding("mono8");
  image.data().resize(static_cast<std::size_t>(rig.width) * rig.height);
  file.read(reinterpret_cast<char*>(image.data().data()), static_cast<std::streamsize>(image.data().size()));
  return image;
}

sensor::CameraInfo_ info_of(const Rig& rig, const sensor::Image_& image, double baseline) {
  sensor::CameraInfo_ info;
  info.header() = image.header();
  info.height(rig.height);
  info.width(rig.width);
  info.distortion_model("plumb_bob");
  info.d(std::vector<double>(5, 0.0));
  info.k({rig.fx, 0, rig.cx, 0, rig.fx, rig.cy, 0, 0, 1});
  info.r({1, 0, 0, 0, 1, 0, 0, 0, 1});
  info.p({rig.fx, 0, rig.cx, -rig.fx * baseline, 0, rig.fx, rig.cy, 0, 0, 0, 1, 0});
  return info;
}

void wait_for_readers(const std::vector<DataWriter*>& writers) {
  PublicationMatchedStatus status;
  for (int i = 0; i < 600; ++i) {
    bool all = true;
    for (DataWriter* one : writers) {
      one->get_publication_matched_status(status);
      all = all && status.current_count > 0;
    }
    if (all) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

/// Waits 50 ms, and longer until a pose more has come: the first one builds kernels.
void wait_for_pose(int before, int most_ms) {
  for (int waited = 0; waited < 50 || (poses == before && waited < most_ms); waited += 10)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

/// Publishes the frames of a file at 20 Hz, or slower where they are tracked more slowly.
void play(DomainParticipant* participant, const char* name) {
  std::ifstream file(name, std::ios::binary);
  const Rig rig{read<std::int32_t>(file), read<std::int32_t>(file), read<std::int32_t>(file), read<double>(file),
                read<double>(file),       read<double>(file),       read<double>(file)};
  DataWriter* images[] = {writer<sensor::Image_PubSubType>(participant, "rt/cam/left/image_rect"),
                          writer<sensor::Image_PubSubType>(participant, "rt/cam/right/image_rect")};
  DataWriter* infos[] = {writer<sensor::CameraInfo_PubSubType>(participant, "rt/cam/left/camera_info"),
                         writer<sensor::CameraInfo_PubSubType>(participant, "rt/cam/right/camera_info")};
  wait_for_readers({images[0], images[1], infos[0], infos[1]});
  for (int i = 0; i < rig.count; ++i) {
    const auto stamp = read<std::int64_t>(file);
    const int before = poses;
    for (int side = 0; side < 2; ++side) {
      sensor::Image_ image = image_of(rig, stamp, file);
      sensor::CameraInfo_ info = info_of(rig, image, side * rig.baseline);
      infos[side]->write(&info);
      images[side]->write(&image);
    }
    wait_for_pose(before, i == 0 ? 20000 : 500);
  }
}

/// A reader or writer of one half of a service, with the qualities of rmw_fastrtps_cpp.
template <class Qos>
Qos of_service() {
  Qos qos;
  qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
  qos.history().depth = 10;
  return qos;
}

/// Calls a service of std_srvs/srv/Trigger as rmw_fastrtps_cpp does: the number of the request is beside the message.
void call(DomainParticipant* participant, const std::string& name) {
  DataWriter* requests = participant->create_publisher(PUBLISHER_QOS_DEFAULT)
                             ->create_datawriter(topic<std_srvs::srv::dds_::Trigger_Request_PubSubType>(
                                                     participant, ("rq" + name + "Request").c_str()),
                                                 of_service<DataWriterQos>());
  DataReader* replies = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT)
                            ->create_datareader(topic<std_srvs::srv::dds_::Trigger_Response_PubSubType>(
                                                    participant, ("rr" + name + "Reply").c_str()),
                                                of_service<DataReaderQos>());
  wait_for_readers({requests});
  SubscriptionMatchedStatus matched;
  for (int i = 0; i < 600 && replies->get_subscription_matched_status(matched) == ReturnCode_t::RETCODE_OK &&
                  matched.current_count == 0;
       ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std_srvs::srv::dds_::Trigger_Request_ request;
  eprosima::fastrtps::rtps::WriteParams asked;
  std_srvs::srv::dds_::Trigger_Response_ reply;
  SampleInfo info;
  bool came = false;
  for (int i = 0; i < 6 && !came; ++i) {  // again where the server has not found this reader yet
    requests->write(&request, asked);
    came = replies->wait_for_unread_message({5, 0}) &&
           replies->take_next_sample(&reply, &info) == ReturnCode_t::RETCODE_OK && info.valid_data;
  }
  const bool names_request = came && info.related_sample_identity == asked.sample_identity();
  std::printf("reply %s %d %d %d %s\n", name.c_str(), came, names_request, reply.success(), reply.message().c_str());
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

  play(participant, arguments[2]);
  std::this_thread::sleep_for(std::chrono::seconds(2));  // what waits is tracked before the reset
  for (const char* service : {"/quadedge/reset", "/quadedge/save_map", "/quadedge/load_map"})
    call(participant, service);
  std::this_thread::sleep_for(std::chrono::seconds(2));
  std::fflush(stdout);
  std::_Exit(0);
}
