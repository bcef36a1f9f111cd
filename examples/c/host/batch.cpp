// As batch.c, in C++17: a batch of any number of acrobots on the heap, and errors as exceptions.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <stdexcept>
#include <vector>

#include "acrobot.h"

namespace {

void check(acrobot_status_t status)
{
    if (status != ACROBOT_OK) {
        throw std::runtime_error(acrobot_status_text(status));
    }
}

class Batch {
public:
    Batch(std::size_t count, std::uint64_t seed)
        : memory(::operator new(acrobot_batch_size(count), alignment)), terminated(new bool[count]),
          truncated(new bool[count]), rewards(count), observations(count)
    {
        check(acrobot_batch_init(memory.get(), acrobot_batch_size(count), count, seed, &batch));
        check(acrobot_batch_set_autoreset(batch, ACROBOT_AUTORESET_SAME_STEP, nullptr));
        check(acrobot_batch_observe(batch, observations.data(), count));
    }

    void step(const std::vector<std::uint8_t> &actions)
    {
        const acrobot_batch_results_t results = {
            rewards.data(), terminated.get(), truncated.get(), observations.data(), nullptr,
        };
        check(acrobot_batch_step(batch, actions.data(), &results, actions.size()));
    }

private:
    static constexpr std::align_val_t alignment{ACROBOT_BATCH_ALIGN};

    struct Free {
        void operator()(void *memory) const { ::operator delete(memory, alignment); }
    };

    // The batch points into its own memory, which stays where it is when this object is moved.
    std::unique_ptr<void, Free> memory;
    acrobot_batch_t *batch = nullptr;

public:
    // Not vectors: those of bool have no array.
    std::unique_ptr<bool[]> terminated, truncated;
    std::vector<float> rewards;
    std::vector<acrobot_observation_t> observations;
};

void run(std::size_t count)
{
    Batch batch(count, 42);
    std::vector<std::uint8_t> actions(count);
    long episodes = 0;
    for (int step = 0; step < 1000; step++) {
        for (std::size_t i = 0; i < count; i++) {
            actions[i] = batch.observations[i].dtheta1 > 0 ? ACROBOT_ACTION_NEGATIVE : ACROBOT_ACTION_POSITIVE;
        }
        batch.step(actions);
        for (std::size_t i = 0; i < count; i++) {
            episodes += batch.terminated[i] || batch.truncated[i];
        }
    }
    std::printf("%ld episodes ended in 1000 steps of %zu acrobots\n", episodes, count);
}

} // namespace

int main(int count, char **arguments)
{
    try {
        run(count > 1 ? std::strtoul(arguments[1], nullptr, 10) : 1000);
    } catch (const std::exception &error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
