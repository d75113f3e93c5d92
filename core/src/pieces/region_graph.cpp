// SPDX-License-Identifier: BSD-3-Clause
#include "pieces/region_graph.h"

namespace pimg {
inline namespace PIMG_ABI {

void RegionGraph::reserve(std::size_t borders)
{
    m_links.reserve(2 * borders);
    m_shared.reserve(borders);
}

void RegionGraph::add(Index a, Index b, Shared shared)
{
    const Index h = Index(m_links.size());
    m_shared.push_back(shared);
    m_links.push_back({ b, kGhost, kGhost });
    m_links.push_back({ a, kGhost, kGhost });
    link(a, h);
    link(b, h + 1);
}

void RegionGraph::link(Index region, Index h)
{
    const Index head = m_first[region];
    m_links[h].previous = kGhost;
    m_links[h].next = head;
    if (head != kGhost)
        m_links[head].previous = h;
    m_first[region] = h;
}

void RegionGraph::unlink(Index region, Index h)
{
    const Link& l = m_links[h];
    if (l.previous == kGhost)
        m_first[region] = l.next;
    else
        m_links[l.previous].next = l.next;
    if (l.next != kGhost)
        m_links[l.next].previous = l.previous;
}

void RegionGraph::merge(Index kept, Index gone)
{
    for (Index h = m_first[kept]; h != kGhost; h = m_links[h].next)
        m_mark[m_links[h].to] = h;
    for (Index h = m_first[gone]; h != kGhost;) {
        const Index next = m_links[h].next, q = m_links[h].to;
        if (q == kept) {
            unlink(kept, h ^ 1);
        } else if (m_mark[q] != kGhost) {
            Shared& into = m_shared[m_mark[q] >> 1];
            into.length += m_shared[h >> 1].length;
            into.strength += m_shared[h >> 1].strength;
            unlink(q, h ^ 1);
        } else {
            m_links[h ^ 1].to = kept;
            link(kept, h);
        }
        h = next;
    }
    m_first[gone] = kGhost;
    for (Index h = m_first[kept]; h != kGhost; h = m_links[h].next)
        m_mark[m_links[h].to] = kGhost;
    m_mark[gone] = kGhost;
}

}  // namespace PIMG_ABI
}  // namespace pimg
