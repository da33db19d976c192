#include "cli/batch_worker.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <new>
#include <stop_token>
#include <thread>

#include <fmt/format.h>

#include "cli/batch_messages.h"
#include "cli/batch_misdeed.h"
#include "cli/batch_order.h"
#include "cli/batch_scene.h"
#include "cli/batch_writer.h"
#include "cli/driver_failure.h"
#include "cli/render_report.h"
#include "engine/film/film_checkpoint.h"

namespace sahl::cli {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto between_messages = std::chrono::milliseconds(100);
/// A frame that was stopped earlier than this is begun again rather than kept.
constexpr double seconds_worth_keeping = 1;

/// What the supervisor says, read on a thread of its own: an order to stop is heard while rendering.
class Orders {
public:
    /// What comes before the first is `settings`.
    Orders(MessageSocket& socket, WorkerSettings& settings) {
        wait_for_settings(socket, settings);
        reader_ = std::thread([this, &socket] { read(socket); });
        reader_.detach();
    }

    /// The next one; nothing once there will be none.
    std::optional<Order> next() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return !orders_.empty() || stop_.stop_requested(); });
        if (stop_.stop_requested()) return std::nullopt;
        Order order = std::move(orders_.front());
        orders_.pop_front();
        return order;
    }
    std::stop_token stop() const { return stop_.get_token(); }

private:
    static void wait_for_settings(MessageSocket& socket, WorkerSettings& settings) {
        for (;;) {
            if (const std::optional<nlohmann::json> message = socket.next()) {
                settings = read_worker_settings(*message);
                return;
            }
            if (!socket.receive()) exit_at_once(0);  // the supervisor is gone
        }
    }

    void read(MessageSocket& socket) {
        do {
            while (const std::optional<nlohmann::json> message = socket.next()) {
                const std::lock_guard lock(mutex_);
                if (message->contains("job")) {
                    orders_.push_back(read_order(*message, content_));
                    content_ = orders_.back().content;
                }
                if (message->contains("stop")) stop_.request_stop();
                changed_.notify_all();
            }
        } while (socket.receive());
        exit_at_once(0);
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Order> orders_{};
    std::shared_ptr<const SceneContent> content_{};  ///< of the last order
    std::stop_source stop_{};
    std::thread reader_;
};

class Worker {
public:
    explicit Worker(int file)
        : socket_(file),
          orders_(socket_, settings_),
          writer_([this](std::size_t job, const std::optional<Error>& error) {
              if (error) {
                  say_failed(job, *error);
              } else {
                  socket_.send({{"written", job}});
              }
          }) {
        set_log_level(settings_.log_level);
    }

    void run() {
        while (const std::optional<Order> order = orders_.next()) {
            try {
                make(*order);
            } catch (const Error& error) {
                say_failed(order->index, error);
            } catch (const std::bad_alloc&) {
                say_failed(order->index, Error(ExitCode::memory,
                                               "out of memory: the scene or its image needs more "
                                               "than there is"));
            } catch (const std::exception& error) {
                say_failed(order->index,
                           Error(ExitCode::internal, fmt::format("internal error: {}", error.what())));
            }
        }
        writer_.finish();
    }

private:
    void say_failed(std::size_t job, const Error& error) {
        socket_.send({{"failed", job}, {"code", static_cast<int>(error.code())}, {"message", error.what()}});
    }

    void make(const Order& order) {
        const BatchJob& job = order.job;
        const auto wait = order.wait ? Claim::Wait::until_free : Claim::Wait::no;
        std::unique_ptr<Claim> claim = Claim::take(job.outputs.front(), wait);
        if (!claim) {
            socket_.send({{"taken", order.index}});
            return;
        }
        ImageToWrite task{.job = order.index, .outputs = outputs_to_write(order), .claim = std::move(claim)};
        if (task.outputs.empty()) {
            socket_.send({{"finished", order.index}});
            return;
        }
        socket_.send({{"started", order.index}});
        misbehave_if_asked(job);
        open_device();
        render(order, scene_->prepare(job, *order.content), std::move(task));
    }

    /// Those that nobody has made, with the claim in hand: so it stays.
    std::vector<BatchOutput> outputs_to_write(const Order& order) {
        std::vector<BatchOutput> outputs = outputs_of(order.job, *order.content, settings_.engine);
        if (!settings_.force)
            std::erase_if(outputs, [&](const auto& o) { return reason_to_render(o, folders_).empty(); });
        return outputs;
    }

    void open_device() {
        if (device_) return;
        device_ = std::make_unique<Device>(settings_.device);
        take_driver_failures();
        device_->memory().set_limit(settings_.max_memory.value_or(physical_memory_bytes()));
        scene_ = std::make_unique<BatchScene>(*device_);
    }

    Checkpoints checkpoints_of(const Order& order, const ImageToWrite& task, const RenderSettings& settings,
                               Film& film) {
        Checkpoints checkpoints;
        // Of the pixels: how files store them does not matter.
        const std::string hash =
            hash_of_record(make_record(order.job, {}, false, *order.content, settings_.engine));
        if (settings_.checkpoint_seconds <= 0) return checkpoints;
        if (const auto samples = read_checkpoint(task.checkpoint, hash, film)) {
            checkpoints.first_sample = *samples;
            const std::uint64_t total = pixel_count(settings.resolution) * std::uint64_t(settings.spp);
            socket_.send({{"resumed", task.job}, {"done", *samples}, {"total", total}});
        }
        const auto last = std::make_shared<Clock::time_point>(Clock::now());
        const std::chrono::duration<double> interval(settings_.checkpoint_seconds);
        checkpoints.due = [last, interval] { return Clock::now() - *last >= interval; };
        checkpoints.save = [path = task.checkpoint, hash, &film, last](std::uint64_t samples) {
            try {
                write_checkpoint(path, hash, samples, film);
            } catch (const Error& error) {
                log_warning(
                    fmt::format("no checkpoint: {}", error.what()));  // the image may still be finished
            }
            *last = Clock::now();
        };
        return checkpoints;
    }

    void render(const Order& order, const PreparedJob& prepared, ImageToWrite task) {
        const BatchJob& job = order.job;
        Device& device = *device_;
        const RenderSettings& settings = prepared.settings;
        const MemoryPlan& plan = prepared.plan;
        task.checkpoint = checkpoint_of(job);
        MemoryReservation layers(device.memory(), plan.aovs, "AOVs");
        if (task.outputs.end() != std::find_if(task.outputs.begin(), task.outputs.end(),
                                               [](const BatchOutput& output) { return output.has_aovs; }))
            task.aovs = scene_->renderer().render_aovs(settings, *job.settings.aovs, orders_.stop());

        Rendered result{{}, prepared.camera, settings, settings.resolution, {}, 0, 0};
        {
            Film film(device.memory(), settings.resolution.width, settings.resolution.height);
            const Checkpoints checkpoints = checkpoints_of(order, task, settings, film);
            auto said = Clock::now();
            const auto say_progress = [&](std::uint64_t done, std::uint64_t total) {
                // Now, as loading keeps PoCL from loading kernels.
                for (const BatchOutput& output : task.outputs) load_encoder(output.path);
                if (Clock::now() - said < between_messages) return;
                said = Clock::now();
                socket_.send({{"progress", task.job}, {"done", done}, {"total", total}});
            };
            result.statistics =
                scene_->renderer().render(settings, film, say_progress, orders_.stop(), checkpoints);
            result.non_finite = film.non_finite_count();
            result.clamped = film.clamped_count();
            if (is_partial(result)) {
                stop_early(task, result, checkpoints);
                return;
            }
            writer_.finish();  // one image and its file at a time
            layers = {};
            task.memory = MemoryReservation(device.memory(), plan.aovs + plan.image + plan.encoder,
                                            "the image and its file");
            task.image = film.resolve(settings.spp);
        }
        add_metadata(job, result, task);
        // This image shall not fail for what the next one does.
        for (const BatchOutput& output : task.outputs) wait_for_encoder(output.path);
        const GenerationCounts rays = total_rays(result.statistics);
        const nlohmann::json message{{"rendered", task.job},
                                     {"seconds", result.statistics.seconds},
                                     {"loaded", prepared.loaded},
                                     {"built", prepared.built},
                                     {"rays", rays.rays},
                                     {"shadow_rays", rays.shadow_rays},
                                     {"non_finite", result.non_finite},
                                     {"clamped", result.clamped}};
        // Said first: the next order may be on its way while this one is handed over.
        socket_.send(message);
        writer_.write(std::move(task));
    }

    void stop_early(const ImageToWrite& task, const Rendered& result, const Checkpoints& checkpoints) {
        // As for an interrupted render, pixels that are not finished are empty: they are begun again.
        const bool keep = checkpoints.save && result.statistics.seconds >= seconds_worth_keeping &&
                          result.statistics.finished_pixels > 0;
        if (keep) checkpoints.save(result.statistics.finished_pixels * std::uint64_t(result.settings.spp));
        socket_.send({{"stopped", task.job}, {"checkpoint", keep}});
    }

    void add_metadata(const BatchJob& job, const Rendered& result, ImageToWrite& task) const {
        RenderOptions options;
        options.scene = job.scene.string();
        options.loading.parameters = job.parameters;
        options.encoding.exposure = job.settings.exposure.value_or(0);
        for (BatchOutput& output : task.outputs) {
            output.encoding.metadata = metadata(result, options, device_->info());
            if (job.frame) output.encoding.metadata.emplace_back("Sahl:Frame", std::to_string(*job.frame));
        }
    }

    WorkerSettings settings_{};
    MessageSocket socket_;
    Orders orders_;
    std::map<fs::path, FolderRecords> folders_{};
    std::unique_ptr<Device> device_{};
    std::unique_ptr<BatchScene> scene_{};
    BatchWriter writer_;
};

}  // namespace

void run_batch_worker(int socket) {
    Worker worker(socket);
    worker.run();
    exit_at_once(0);
}

}  // namespace sahl::cli
