// Visits the splats whose boxes overlap the tile. The including file defines
//   WALK: the name of the function;
//   WALK_STEPS: the number of loop iterations after which it stops;
//   WALK_BEHIND: inverse depth (κ) of the farthest visible surface; boxes behind it are skipped. It may rise during the walk;
//   WALK_TAKE(count, id): processes a batch of `count` splats, at most LANES; each lane has the `id` of one;
//   WALK_KEEP: optional; records the visited splats in met_list.
// Blocks of 512 splats are visited near to far, splats within a block by index.
//
// Loops end by `do … while`, and nothing is skipped by `if`: lavapipe only masks that.

void WALK(uvec2 low, uvec2 high) {
    // Groups of siblings that are open on the levels from blocks up: of each a bit a sibling that remains, by its turn, and the children by turn.
    uvec2 open_groups = uvec2(0);
    uint turns[LEVELS];
    uint depth = hierarchy.level - BLOCKS, group = hierarchy.group;
    {
        Box box = load_box(hierarchy.starts[hierarchy.level] + FAN_OUT * group + lane % FAN_OUT);
        bool wanted = meets(box, low, high) && nearest_in(box) > WALK_BEHIND && lane < FAN_OUT;
        uint turn;
        uint met = turns_of(wanted, nearest_in(box), turn);
        for (uint l = 0; l < LEVELS; l++) turns[l] = turn;
        own_start = hierarchy.starts[1 + lane % FAN_OUT];
        open_groups = group_bits(met, depth);
    }
    // Splats that wait for a batch to be full: the lanes' first, and those beyond.
    uint first_waiting = 0, later_waiting = 0, waiting = 0;
    int left = WALK_STEPS;
    bool more = true;
    do {
        // The next block.
        uint block = 0;
        bool found = false;
        do {
            bool is_low = open_groups.x != 0;
            uint bits = is_low ? open_groups.x : open_groups.y;
            more = bits != 0;
            uint at = uint(max(findLSB(bits), 0)) + (is_low ? 0 : 32);
            uint own = at >> 3;
            uint turn = turns[0];
            for (uint l = 1; l < LEVELS; l++) turn = own == l ? turns[l] : turn;
            open_groups.x &= is_low ? bits - 1 : 0;
            open_groups.y &= is_low ? open_groups.y : bits - 1;
            group >>= 3 * (own - depth);
            uint node = FAN_OUT * group + (turn >> 3 * (at & 7u) & 7u);
            found = more && own == 0;
            block = found ? node : block;
            depth = own;
            bool opens = more && own > 0;
            {
                uint finer = max(own, 1) - 1, start = level_start(finer + BLOCKS);
                Box box = load_box(opens ? start + FAN_OUT * node + lane % FAN_OUT : 0);
                bool wanted = opens && meets(box, low, high) && nearest_in(box) > WALK_BEHIND && lane < FAN_OUT;
                uint turn;
                uint met = turns_of(wanted, nearest_in(box), turn);
                for (uint l = 0; l < LEVELS; l++) turns[l] = opens && finer == l ? turn : turns[l];
                open_groups |= group_bits(met, finer);
                group = opens ? node : group;
                depth = opens ? finer : depth;
            }
        } while (more && !found);

        // Its nodes of level 2 that remain, in the upper bits, and of one of them those of level 1.
        uint open = 0, parent = 0, nodes_start = level_start(1);
        {
            Box box = load_box(level_start(BLOCKS - 1) + FAN_OUT * block + lane % FAN_OUT);
            bool wanted = found && meets(box, low, high) && nearest_in(box) > WALK_BEHIND && lane < FAN_OUT;
            open = team_ballot(wanted) << FAN_OUT;
        }
        do {
            do {
                uint at = uint(max(findLSB(open), 0));
                bool of_splats = at < FAN_OUT;
                uint node = of_splats ? FAN_OUT * parent + at : FAN_OUT * block + at - FAN_OUT;
                uint start = of_splats ? 0 : nodes_start;
                Box box = load_box(start + FAN_OUT * node + lane % FAN_OUT);
                bool wanted = open != 0 && meets(box, low, high) && nearest_in(box) > WALK_BEHIND && lane < FAN_OUT;
                uint met = team_ballot(wanted);
                open &= ~(1u << at);
                parent = of_splats ? parent : node;
                open |= of_splats ? 0 : met;
                met = of_splats ? met : 0;
                uint appended = compacted(FAN_OUT * node + lane, met);
                // All lanes take part in passing values on, whether they want one or not.
                uint fills = of_lane(appended, lane - waiting);
                first_waiting = lane < waiting ? first_waiting : fills;
                later_waiting = of_lane(appended, lane + LANES - waiting);
                waiting += bitCount(met);
                left--;
            } while (open != 0 && waiting < LANES && left > 0);
            uint count = min(waiting, LANES);
            uint id = lane < count ? first_waiting : 0;
#ifdef WALK_KEEP
            if (lane < count && met_count < MOST_MET) met_list[met_count + lane] = id;
            met_count += count;
#endif
            WALK_TAKE(count, id);
            first_waiting = later_waiting;
            waiting -= count;
            left -= int(LANES / AT_A_TIME) + 1;
        } while ((open != 0 || waiting > 0) && left > 0);
    } while (more && left > 0);
}

#undef WALK
#undef WALK_BEHIND
#undef WALK_TAKE
#undef WALK_STEPS
#undef WALK_KEEP
