// Visits the splats whose boxes overlap the tile. The including file defines
//   WALK: the name of the function;
//   WALK_STEPS: the number of loop iterations after which it stops where the device has LIMITED_LOOPS;
//   WALK_CULL_KEY: inverse depth (κ) of the farthest visible surface; boxes behind it are skipped. It may rise during the walk;
//   WALK_BATCH(count, id): processes a batch of `count` splats, at most LANES; each lane has the `id` of one;
//   WALK_UNROLLED: optional; splats of a batch that one loop iteration processes, UNROLLED if undefined;
//   WALK_RECORDS: optional; visited_count is the number of visited splats, which are in visited_ids if they are at most MOST_VISITED.
// Blocks of 512 splats are visited near to far, splats within a block by index.
//
// Loops are `do … while`, and values are selected instead of branched on: lavapipe only masks branches.

#ifndef WALK_UNROLLED
#define WALK_UNROLLED UNROLLED
#endif

#ifdef WALK_RECORDS
#define WALK_START 0
#else
#define WALK_START SCRATCH
#endif

// First, the ids in visited_ids from `first` to `end` are processed. Then, if there is `more`, those of the splats that overlap the tile are
// appended there, block by block, and processed as soon as they fill a batch.
void WALK(uvec2 origin, uvec2 last, uint first, uint end, bool more) {
    // Open groups of siblings, per level from blocks up: a bit per remaining sibling, in order, and the order of siblings.
    uvec2 open_groups = uvec2(0);
    uint orders[LEVELS];
    // Of the open group of blocks: κ of the lane's sibling, as more of them may be occluded when their turn comes.
    float block_key = 0.0;
    uint depth = hierarchy.level - BLOCKS, group = hierarchy.group;
    {
        Box box = load_box(hierarchy.starts[hierarchy.level] + FAN_OUT * group + lane % FAN_OUT);
        bool hit = more && overlaps(box, origin, last) && nearest_key(box) > WALK_CULL_KEY && lane < FAN_OUT;
        uint order;
        uint hits = sort_hits(hit, nearest_key(box), order);
        for (uint l = 0; l < LEVELS; l++) orders[l] = order;
        lane_level_start = hierarchy.starts[1 + lane % FAN_OUT];
        open_groups = group_bits(hits, depth);
        block_key = nearest_key(box);
    }
    int steps_left = LIMITED_LOOPS ? min(WALK_STEPS, int(hierarchy.most_steps)) : int(hierarchy.most_steps);
    uint nodes_start = level_start(1), parents_start = level_start(BLOCKS - 1);
    do {
        do {
            // Finds the next block.
            uint block = 0;
            bool found = false;
            do {
                bool is_low = open_groups.x != 0;
                uint bits = is_low ? open_groups.x : open_groups.y;
                more = bits != 0;
                uint bit = uint(max(findLSB(bits), 0)) + (is_low ? 0 : 32);
                uint level = bit >> 3;
                uint order = orders[0];
                for (uint l = 1; l < LEVELS; l++) order = level == l ? orders[l] : order;
                open_groups.x &= is_low ? bits - 1 : 0;
                open_groups.y &= is_low ? open_groups.y : bits - 1;
                group >>= 3 * (level - depth);
                uint sibling = order >> 3 * (bit & 7u) & 7u, node = FAN_OUT * group + sibling;
                found = more && level == 0 && shuffle(block_key, sibling) > WALK_CULL_KEY;
                block = found ? node : block;
                depth = level;
                bool opens = more && level > 0;
                {
                    uint finer = max(level, 1) - 1, start = level_start(finer + BLOCKS);
                    Box box = load_box(opens ? start + FAN_OUT * node + lane % FAN_OUT : 0);
                    bool hit = opens && overlaps(box, origin, last) && nearest_key(box) > WALK_CULL_KEY && lane < FAN_OUT;
                    uint order;
                    uint hits = sort_hits(hit, nearest_key(box), order);
                    for (uint l = 0; l < LEVELS; l++) orders[l] = opens && finer == l ? order : orders[l];
                    block_key = opens && finer == 0 ? nearest_key(box) : block_key;
                    open_groups |= group_bits(hits, finer);
                    group = opens ? node : group;
                    depth = opens ? finer : depth;
                }
                steps_left--;
            } while (more && !found && steps_left > 0);

            // Its remaining nodes of level 2, in the upper bits, and of one of them those of level 1.
            uint open_nodes = 0, parent = 0;
            {
                Box box = load_box(parents_start + FAN_OUT * block + lane % FAN_OUT);
                bool hit = found && overlaps(box, origin, last) && nearest_key(box) > WALK_CULL_KEY && lane < FAN_OUT;
                open_nodes = workgroup_ballot(hit) << FAN_OUT;
            }
            do {
                uint bit = uint(max(findLSB(open_nodes), 0));
                bool is_leaf = bit < FAN_OUT;
                uint node = is_leaf ? FAN_OUT * parent + bit : FAN_OUT * block + bit - FAN_OUT;
                uint start = is_leaf ? 0 : nodes_start;
                Box box = load_box(start + FAN_OUT * node + lane % FAN_OUT);
                bool hit = open_nodes != 0 && overlaps(box, origin, last) && nearest_key(box) > WALK_CULL_KEY && lane < FAN_OUT;
                hit = hit && !(is_of_fronts() && is_leaf && is_back(box));
                uint hits = workgroup_ballot(hit);
                open_nodes &= ~(1u << bit);
                parent = is_leaf ? parent : node;
                open_nodes |= is_leaf ? 0 : hits;
                if (hit && is_leaf) visited_ids[end + bitCount(hits & ((1u << lane) - 1u))] = FAN_OUT * node + lane;
                end += is_leaf ? bitCount(hits) : 0;
                steps_left--;
            } while (open_nodes != 0 && steps_left > 0);
            more = (open_groups.x | open_groups.y) != 0 && WALK_CULL_KEY < COMPLETE;
            steps_left--;
        } while (more && end - first < LANES && steps_left > 0);
        WORKGROUP_BARRIER();
        // Full batches, and an incomplete one at the end.
        do {
            uint pending = end - first;
            uint count = pending >= LANES || !more ? min(pending, LANES) : 0;
            uint id = lane < count ? visited_ids[first + lane] : 0;
            WALK_BATCH(count, id);
            first += count;
            steps_left -= int(LANES / WALK_UNROLLED) + 1;
        } while (end > first && (end - first >= LANES || !more) && steps_left > 0);
        // Makes room for the splats of a block.
        {
            uint pending = end - first;
#ifdef WALK_RECORDS
            bool wraps = end > MOST_VISITED;
            visited_count = wraps ? MOST_VISITED + 1 : visited_count;
#else
            const bool wraps = true;
#endif
            uint id = lane < pending ? visited_ids[first + lane] : 0;
            WORKGROUP_BARRIER();
            if (wraps && lane < pending) visited_ids[WALK_START + lane] = id;
            first = wraps ? WALK_START : first;
            end = wraps ? WALK_START + pending : end;
        }
        steps_left--;
    } while (more && steps_left > 0);
#ifdef WALK_RECORDS
    visited_count = max(visited_count, end);
#endif
    incomplete = incomplete || steps_left <= 0;
}

#undef WALK
#undef WALK_CULL_KEY
#undef WALK_BATCH
#undef WALK_STEPS
#undef WALK_UNROLLED
#undef WALK_START
#undef WALK_RECORDS
