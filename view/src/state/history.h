// SPDX-License-Identifier: BSD-3-Clause
// Undo and redo.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace pimgview {

/// The states something was in. `State` can be compared and is small.
template<class State>
class History {
public:
    explicit History(State first) : m_states { std::move(first) } { }

    /// Remembers a state, unless it is the present one. What was undone is forgotten.
    void record(const State& state)
    {
        if (state == m_states[m_now])
            return;
        m_states.resize(m_now + 1);
        m_states.push_back(state);
        if (m_states.size() > kMost)
            m_states.erase(m_states.begin());
        m_now = m_states.size() - 1;
    }

    bool can_undo() const { return m_now > 0; }
    bool can_redo() const { return m_now + 1 < m_states.size(); }
    const State& undo() { return m_states[can_undo() ? --m_now : m_now]; }
    const State& redo() { return m_states[can_redo() ? ++m_now : m_now]; }
    const State& now() const { return m_states[m_now]; }

private:
    static constexpr std::size_t kMost = 1000;  ///< far more than anybody goes back, and a few hundred kilobytes

    std::vector<State> m_states;
    std::size_t m_now = 0;
};

}  // namespace pimgview
