"""Many clients in one process, for the load tests: each hears a topic of 60 messages a second and publishes as many.

Arguments: the address, how many clients, how many seconds. The last line printed is a JSON object: ``own`` messages that came back to
their sender, ``common`` ones of the topic that all hear, how many are ``lost`` or out of order.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time

from websockets.asyncio.client import connect

RATE = 60


async def client(address, number, seconds, ready, begin):
    """(own, common, lost, disorder) of one client."""
    topic, count = f"/client{number}", seconds * RATE
    async with connect(address, compression=None, max_size=None, ping_interval=None) as wire:
        await wire.send(json.dumps({"op": "subscribe", "topic": "/ticks", "type": "std_msgs/UInt32"}))
        await wire.send(json.dumps({"op": "advertise", "topic": topic, "type": "std_msgs/UInt32"}))
        await wire.send(json.dumps({"op": "subscribe", "topic": topic}))
        own, common = [], []

        async def hear():
            while len(common) < count or len(own) < count:
                message = json.loads(await wire.recv())
                (own if message["topic"] == topic else common).append(message["msg"]["data"])

        ready.release()
        await begin.wait()
        hearing = asyncio.create_task(hear())
        start = time.monotonic()
        for index in range(count):
            await wire.send(json.dumps({"op": "publish", "topic": topic, "msg": {"data": index}}))
            pause = start + (index + 1) / RATE - time.monotonic()
            if pause > 0:
                await asyncio.sleep(pause)
        await asyncio.wait_for(hearing, seconds + 60)
        lost = common[-1] - common[0] + 1 - len(set(common)) + count - len(set(own))
        return len(own), len(common), lost, int(own != sorted(own)) + int(common != sorted(common))


async def main(address, clients, seconds):
    ready, begin = asyncio.Semaphore(0), asyncio.Event()
    tasks = [asyncio.create_task(client(address, number, seconds, ready, begin)) for number in range(clients)]
    for _ in tasks:
        await ready.acquire()
    print("ready", flush=True)
    begin.set()
    found = await asyncio.gather(*tasks)
    print(json.dumps(dict(zip(("own", "common", "lost", "disorder"), map(sum, zip(*found))))), flush=True)


asyncio.run(main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3])))
