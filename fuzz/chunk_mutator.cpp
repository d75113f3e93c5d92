// SPDX-License-Identifier: BSD-3-Clause
// Mutations that keep the framing of a file: a chunk's payload changes and its length and checksum follow, or whole chunks
// are left out, repeated or exchanged. Without this nearly all inputs would fail at the first checksum. What lies before
// the signature, such as the query that the plugin is given, is mutated as text. Part of the fuzzers only.
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <random>
#include <vector>

#include "container.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace {

using namespace pimg;

struct Chunk {
    char type[5];
    std::uint16_t flags;
    Bytes payload;
};

/// The whole chunks after the signature; `rest` receives the bytes behind the last one.
std::vector<Chunk> split(const std::uint8_t* data, std::size_t size, Bytes& rest)
{
    std::vector<Chunk> chunks;
    std::size_t at = sizeof kSignature;
    ChunkHead head;
    while (size - at >= kChunkHead + kChunkTail && parse_chunk_head(data + at, head)
           && head.length <= size - at - kChunkHead - kChunkTail) {
        Chunk chunk;
        std::memcpy(chunk.type, head.type, sizeof chunk.type);
        chunk.flags = head.flags;
        chunk.payload.assign(data + at + kChunkHead, data + at + kChunkHead + head.length);
        chunks.push_back(std::move(chunk));
        at += kChunkHead + std::size_t(head.length) + kChunkTail;
    }
    rest.assign(data + at, data + size);
    return chunks;
}

void mutate_payload(Bytes& payload, std::size_t room)
{
    const std::size_t size = payload.size();
    payload.resize(size + std::min<std::size_t>(room, 64 + size));
    payload.resize(LLVMFuzzerMutate(payload.data(), size, payload.size()));
}

void mutate_chunks(std::vector<Chunk>& chunks, std::size_t room, std::mt19937& random)
{
    Chunk& chosen = chunks[random() % chunks.size()];
    switch (random() % 16) {
    case 0:
        chunks.erase(chunks.begin() + std::ptrdiff_t(random() % chunks.size()));
        break;
    case 1:
        chunks.insert(chunks.begin() + std::ptrdiff_t(random() % (chunks.size() + 1)), Chunk(chosen));
        break;
    case 2:
        std::swap(chosen, chunks[random() % chunks.size()]);
        break;
    case 3:
        chosen.flags = std::uint16_t(random() % 4);
        break;
    default:
        mutate_payload(chosen.payload, room);
    }
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed)
{
    std::mt19937 random(seed);
    const std::uint8_t* file = std::search(data, data + size, std::begin(kSignature), std::end(kSignature));
    if (file == data + size || random() % 16 == 0)  // no file in it, or without mending the checksums
        return LLVMFuzzerMutate(data, size, max_size);
    Bytes before(data, const_cast<std::uint8_t*>(file)), rest;
    std::vector<Chunk> chunks = split(file, size - before.size(), rest);
    if (!before.empty() && random() % 3 == 0)
        mutate_payload(before, max_size - size);
    else if (!chunks.empty())
        mutate_chunks(chunks, max_size - size, random);
    Bytes mutated = before;
    put_bytes(mutated, kSignature, sizeof kSignature);
    for (const Chunk& chunk : chunks)
        put_chunk(mutated, chunk.type, chunk.flags, chunk.payload);
    put_bytes(mutated, rest.data(), rest.size());
    const std::size_t result = std::min(mutated.size(), max_size);
    std::memcpy(data, mutated.data(), result);
    return result;
}
